// SPDX-License-Identifier: MIT
// The scene's vertices, matrices and textures on the GPU, drawn in few calls.
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
    explicit GpuScene(const SceneState& state);
    // Sends the matrices of the state if they changed.
    void update(const SceneState& state);
    void draw(const Draw& draw, const Programs& programs) const override;

private:
    // As glMultiDrawElementsIndirect reads it.
    struct Command {
        uint32_t count, instances, firstIndex;
        int32_t baseVertex;
        uint32_t baseInstance; // of the instanced attributes: the command's own index
    };
    // Neighbouring commands that may be drawn in one call for every purpose.
    struct Batch {
        uint32_t firstCommand, commandCount;
        int texture; // of Scene::textures, -1: none
        bool masked, doubleSided, mirrored, casts, closed;
    };
    struct DrawData { // the instanced attributes of shaders/draws.glsl; matrices by rows
        glm::mat3x4 worldFromModel;
        glm::vec4 baseColour, emissive_cutoff;
        glm::mat3x4 lastWorldFromModel;
    };
    static void destroyVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
    static void destroyTexture(GLuint name) { glDeleteTextures(1, &name); }
    using TextureHandle = Handle<destroyTexture>;
    static TextureHandle upload(const TextureImage& image);

    std::vector<uint32_t> drawableOfCommand_; // index into SceneState::drawables(); drawables().size(): the ground
    std::vector<Batch> batches_;
    std::vector<DrawData> draws_; // one per command
    Buffer positions_, normals_, uvs_, indices_, commands_, drawBuffer_;
    Handle<destroyVertexArray> vertexArray_;
    std::vector<TextureHandle> textures_; // as Scene::textures, then a white one
    uint64_t sentVersion_ = 0;
    bool sentMotion_ = false; // the last matrices sent differ between frames
    uint32_t groundVertices_ = 0;
};

} // namespace penumbra
