// SPDX-License-Identifier: MIT
// The scene's vertices, matrices and textures on the GPU, posed by a compute pass and drawn in few calls.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/geometry.h"
#include "renderer/gl/texture.h"
#include "renderer/scene/scene_state.h"

#include <memory>
#include <vector>

namespace penumbra {

class GpuScene final : public Geometry {
public:
    // Makes buffers and textures in the current context, which may be another one than the one that draws, if the two
    // share objects. Takes long for a large scene.
    explicit GpuScene(const SceneState& state, Progress* progress = nullptr);
    // Sends the matrices, joints and weights of the state if they changed.
    void update(const SceneState& state);

    bool hasColours() const override { return colours_.bytes() > 0; }
    void pose(const Program& program) const override;
    size_t pieces() const override { return commandCount_; } // a command each
    void draw(const Draw& draw, const Programs& programs, size_t firstPiece, size_t pieces) const override;

private:
    // As glMultiDrawElementsIndirect reads it.
    struct Command {
        uint32_t count, instances, firstIndex;
        int32_t baseVertex;
        uint32_t baseInstance; // of the instanced attributes
    };
    // Neighbouring commands that may be drawn in one call for every purpose.
    struct Batch {
        uint32_t firstCommand, commandCount;
        int texture; // of Scene::textures, -1: none
        bool masked, doubleSided, mirrored, casts, closed, posed;
    };
    struct DrawData { // the instanced attributes of shaders/draws.glsl; matrices by rows
        glm::mat3x4 worldFromModel;
        glm::vec4 baseColour, emissive_unlit;
        glm::mat3x4 lastWorldFromModel;
    };
    // Vertices that a node poses, as shaders/pose.glsl reads it. All indices are into the streams.
    struct PoseJob {
        uint32_t firstPosed, firstVertex, vertexCount; // to, from
        uint32_t firstInfluence, influenceSets, firstJoint;
        uint32_t firstDelta, morphTargets, firstWeight;
    };
    static void destroyVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
    static void destroyTexture(GLuint name) { glDeleteTextures(1, &name); }
    using TextureHandle = Handle<destroyTexture>;
    static TextureHandle upload(const TextureImage& image);

    // Posed vertices, then the scene's own, then the square of the ground.
    void planPoses(const SceneState& state);
    void uploadVertices(const Scene& scene);
    void planDraws(const SceneState& state);
    void makeVertexArray() const;

    uint32_t posedVertices_ = 0;
    std::vector<PoseJob> jobs_;
    std::vector<int32_t> firstPosed_;      // by drawable, −1: not posed
    std::vector<uint32_t> drawableOfDraw_; // index into SceneState::drawables(); drawables().size(): the ground
    std::vector<Batch> batches_;
    std::vector<DrawData> draws_;
    uint32_t commandCount_ = 0, groundCommand_ = 0, groundVertices_ = 0;
    Buffer positions_, lastPositions_, normals_, uvs_, colours_, indices_, commands_, drawBuffer_, objects_;
    Buffer influences_, deltas_, jobBuffer_, joints_, weights_; // of what is posed
    std::vector<glm::mat3x4> jointRows_;                        // as sent
    std::vector<TextureHandle> textures_;                       // as Scene::textures, then a white one
    mutable Handle<destroyVertexArray> vertexArray_;            // made by the context that draws
    uint64_t sentVersion_ = 0;
    bool sentMotion_ = false; // the last matrices sent differ between frames
};

} // namespace penumbra
