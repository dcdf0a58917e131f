// SPDX-License-Identifier: MIT
#include "renderer/scene/gpu_scene.h"

#include "renderer/scene/posing.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <map>
#include <thread>
#include <tuple>

namespace penumbra {
namespace {

GLint glWrap(Wrap wrap) {
    switch (wrap) {
    case Wrap::Repeat: return GL_REPEAT;
    case Wrap::MirroredRepeat: return GL_MIRRORED_REPEAT;
    case Wrap::ClampToEdge: return GL_CLAMP_TO_EDGE;
    }
    return GL_REPEAT;
}

// A unit square in the xz plane, facing up; the ground is this, moved and scaled.
constexpr glm::vec3 squarePositions[] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
constexpr uint32_t squareIndices[] = {0, 1, 2, 0, 2, 3};
constexpr uint32_t mostIndices = 3 << 14; // of a command, its instances together, if there are several
constexpr glm::vec4 groundColour{0.5f, 0.5f, 0.5f, 1};

glm::mat4 worldFromSquare(const Ground& ground) {
    const glm::mat4 moved = glm::translate(glm::mat4(1), {ground.centre.x, ground.height, ground.centre.y});
    return glm::scale(moved, glm::vec3(ground.halfSize, 1, ground.halfSize));
}

// The upper three rows of a matrix whose last row is 0 0 0 1.
glm::mat3x4 affineRows(const glm::mat4& matrix) { return glm::mat3x4(glm::transpose(matrix)); }

void destroyFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

// Each level from the one above it, by a bilinear filter in linear light. glGenerateTextureMipmap does the same, but
// Mesa locks what contexts share until it is done, the compilation of its shaders included, and a window that draws
// beside a loading scene stands still so long.
void makeMipmaps(GLuint texture, int width, int height, int levels) {
    GLuint names[2];
    glCreateFramebuffers(2, names);
    const Handle<destroyFramebuffer> from(names[0]), to(names[1]);
    glEnable(GL_FRAMEBUFFER_SRGB);
    for (int level = 1; level < levels; ++level) {
        const int smallerWidth = std::max(width / 2, 1), smallerHeight = std::max(height / 2, 1);
        glNamedFramebufferTexture(from.get(), GL_COLOR_ATTACHMENT0, texture, level - 1);
        glNamedFramebufferTexture(to.get(), GL_COLOR_ATTACHMENT0, texture, level);
        glBlitNamedFramebuffer(from.get(), to.get(), 0, 0, width, height, 0, 0, smallerWidth, smallerHeight,
                               GL_COLOR_BUFFER_BIT, GL_LINEAR);
        width = smallerWidth, height = smallerHeight;
    }
    glDisable(GL_FRAMEBUFFER_SRGB);
}

} // namespace

GpuScene::TextureHandle GpuScene::upload(const TextureImage& image) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    TextureHandle handle(name);
    const int levels = std::bit_width(static_cast<unsigned>(std::max(image.width, image.height)));
    glTextureStorage2D(name, levels, GL_SRGB8_ALPHA8, image.width, image.height);
    glTextureSubImage2D(name, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    makeMipmaps(name, image.width, image.height, levels);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, glWrap(image.wrapU));
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, glWrap(image.wrapV));
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, image.magnifyNearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glObjectLabel(GL_TEXTURE, name, static_cast<GLsizei>(std::min<size_t>(image.name.size(), 200)), image.name.data());
    return handle;
}

GpuScene::GpuScene(const SceneState& state, Progress* progress) {
    const auto pause = [&] {
        if (!progress) return;
        progress->report("sending it to the GPU", 1);
        glFlush();
        // A driver locks what contexts share during an upload; another thread that draws gets its turn here.
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    planPoses(state);
    uploadVertices(*state.scene());
    planDraws(state);
    for (const TextureImage& image : state.scene()->textures) {
        pause();
        textures_.push_back(upload(image));
    }
    textures_.push_back(upload({.name = "white", .width = 1, .height = 1, .rgba = {255, 255, 255, 255}}));
    update(state);
}

// Primitives of one mesh may share their vertices; a node then poses them once.
void GpuScene::planPoses(const SceneState& state) {
    const Scene& scene = *state.scene();
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> known; // by node and first vertex
    for (const Drawable& d : state.drawables()) {
        firstPosed_.push_back(-1);
        if (!d.posed) continue;
        const Primitive& p = state.primitive(d);
        const Node& node = scene.nodes[d.node];
        const auto [job, isNew] = known.try_emplace({d.node, p.firstVertex}, posedVertices_);
        firstPosed_.back() = static_cast<int32_t>(job->second);
        if (!isNew) continue;
        const bool skinned = isSkinned(node, p);
        jobs_.push_back({posedVertices_, p.firstVertex, p.vertexCount, p.firstInfluence, skinned ? p.influenceSets : 0,
                         skinned ? scene.skins[static_cast<size_t>(node.skin)].firstMatrix : 0, p.firstDelta,
                         p.morphTargets, node.firstWeight});
        posedVertices_ += p.vertexCount;
    }
    for (PoseJob& job : jobs_) job.firstVertex += posedVertices_;
}

void GpuScene::uploadVertices(const Scene& scene) {
    // At rest until they are posed.
    const auto stream = [&](std::string_view label, const auto& own, const auto& square) {
        constexpr size_t size = sizeof(own[0]);
        Buffer buffer(label, (posedVertices_ + own.size() + std::size(square)) * size, nullptr, GL_DYNAMIC_STORAGE_BIT);
        for (const PoseJob& job : jobs_)
            buffer.update(job.firstPosed * size, job.vertexCount * size, own.data() + job.firstVertex - posedVertices_);
        if (!own.empty()) buffer.update(posedVertices_ * size, own.size() * size, own.data());
        buffer.update((posedVertices_ + own.size()) * size, std::size(square) * size, std::data(square));
        return buffer;
    };
    groundVertices_ = posedVertices_ + static_cast<uint32_t>(scene.positions.size());
    positions_ = stream("positions", scene.positions, squarePositions);
    normals_ = stream("normals", scene.normals, std::vector<glm::vec3>(4, glm::vec3(0, 1, 0)));
    uvs_ = stream("uvs", scene.uvs, std::vector<glm::vec2>(4, glm::vec2(0)));
    if (!scene.colours.empty())
        colours_ = stream("colours", scene.colours, std::vector<glm::u16vec4>(4, glm::u16vec4(65535)));

    const size_t bytes = scene.indices.size() * sizeof(uint32_t);
    indices_ = Buffer("indices", bytes + sizeof(squareIndices), nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (bytes) indices_.update(0, bytes, scene.indices.data());
    indices_.update(bytes, sizeof(squareIndices), squareIndices);

    if (jobs_.empty()) return;
    const auto whole = [](std::string_view label, const auto& list, GLbitfield flags = 0) {
        const size_t size = std::max<size_t>(list.size(), 1) * sizeof(list[0]); // a buffer of nothing cannot be bound
        return Buffer(label, size, list.empty() ? nullptr : list.data(), flags);
    };
    lastPositions_ = Buffer("last positions", posedVertices_ * sizeof(glm::vec3), nullptr, GL_DYNAMIC_STORAGE_BIT);
    influences_ = whole("influences", scene.influences);
    deltas_ = whole("morph deltas", scene.morphDeltas);
    jobBuffer_ = whole("pose jobs", jobs_);
    weights_ = whole("morph weights", scene.restWeights, GL_DYNAMIC_STORAGE_BIT);
    size_t joints = 0;
    for (const Skin& skin : scene.skins) joints += skin.joints.size();
    jointRows_.resize(joints);
    joints_ = whole("joints", jointRows_, GL_DYNAMIC_STORAGE_BIT);
}

// Commands in an order that makes long batches: all opaque casters stand together. Instances of one small primitive are
// one command, a large primitive is several, so that a dear pass can be drawn piece by piece.
void GpuScene::planDraws(const SceneState& state) {
    const Scene& scene = *state.scene();
    struct Keyed {
        uint32_t drawable;
        Batch batch;
    };
    std::vector<Keyed> order;
    const uint32_t ground = static_cast<uint32_t>(state.drawables().size());
    for (uint32_t i = 0; i < ground; ++i) {
        const Drawable& d = state.drawables()[i];
        const Primitive& p = state.primitive(d);
        const Material& material = scene.materials[static_cast<size_t>(p.material)];
        const bool mirrored = isMirrored(scene, state.pose(), d.node, p);
        order.push_back(
            {i, {0, 0, material.texture, material.masked, material.doubleSided, mirrored, true, p.closed, d.posed}});
    }
    order.push_back({ground, {0, 0, -1, false, true, false, false, false, false}});
    const auto key = [](const Batch& b) {
        return std::tuple(!b.casts, b.masked, b.texture, b.posed, b.closed, b.doubleSided, b.mirrored);
    };
    const auto drawn = [&](const Keyed& k) { // equal: instances of the same
        if (k.drawable == ground) return std::pair(~0u, ~0u);
        const Drawable& d = state.drawables()[k.drawable];
        return d.posed ? std::pair(~0u - 1, k.drawable) : std::pair(d.mesh, d.primitive);
    };
    std::stable_sort(order.begin(), order.end(), [&](const Keyed& a, const Keyed& b) {
        return std::pair(key(a.batch), drawn(a)) < std::pair(key(b.batch), drawn(b));
    });

    std::vector<Command> commands;
    std::vector<float> objects; // a node each; the ground is one, too
    for (size_t i = 0; i < order.size(); ++i) {
        const Keyed& keyed = order[i];
        const bool newBatch = i == 0 || key(order[i - 1].batch) != key(keyed.batch);
        const uint32_t commandsBefore = static_cast<uint32_t>(commands.size());
        const uint32_t draw = static_cast<uint32_t>(draws_.size());
        DrawData data{affineRows(glm::mat4(1)), groundColour, glm::vec4(0), affineRows(glm::mat4(1))};
        if (keyed.drawable == ground) {
            groundCommand_ = static_cast<uint32_t>(commands.size());
            commands.push_back({std::size(squareIndices), 0, static_cast<uint32_t>(scene.indices.size()),
                                static_cast<int32_t>(groundVertices_), draw});
        } else {
            const Drawable& d = state.drawables()[keyed.drawable];
            const Primitive& p = state.primitive(d);
            const Material& material = scene.materials[static_cast<size_t>(p.material)];
            const int32_t posed = firstPosed_[keyed.drawable];
            const uint32_t firstVertex = posed >= 0 ? static_cast<uint32_t>(posed) : posedVertices_ + p.firstVertex;
            // Another instance of the last command, or commands of their own.
            if (!newBatch && drawn(order[i - 1]) == drawn(keyed) &&
                uint64_t(commands.back().instances + 1) * p.indexCount <= mostIndices)
                ++commands.back().instances;
            else
                for (uint32_t first = 0; first < p.indexCount; first += mostIndices)
                    commands.push_back({std::min(mostIndices, p.indexCount - first), 1, p.firstIndex + first,
                                        static_cast<int32_t>(firstVertex), draw});
            data.baseColour = glm::vec4(glm::vec3(material.baseColour), leastAlpha(material));
            data.emissive_unlit = glm::vec4(material.emissive, material.unlit ? 1 : 0);
        }
        draws_.push_back(data);
        objects.push_back(1 + static_cast<float>(keyed.drawable == ground ? scene.nodes.size()
                                                                          : state.drawables()[keyed.drawable].node));
        drawableOfDraw_.push_back(keyed.drawable);
        if (newBatch) {
            batches_.push_back(keyed.batch);
            batches_.back().firstCommand = commandsBefore;
        }
        batches_.back().commandCount += static_cast<uint32_t>(commands.size()) - commandsBefore;
    }
    commandCount_ = static_cast<uint32_t>(commands.size());
    commands_ = Buffer("draw commands", commands.size() * sizeof(Command), commands.data(), GL_DYNAMIC_STORAGE_BIT);
    drawBuffer_ = Buffer("draws", draws_.size() * sizeof(DrawData), draws_.data(), GL_DYNAMIC_STORAGE_BIT);
    objects_ = Buffer("objects", objects.size() * sizeof(float), objects.data());
}

namespace {
// The bindings of vertex buffers; locations 3 to 10 are instanced.
constexpr GLuint positionBinding = 0, normalBinding = 1, uvBinding = 2, instancedBinding = 3, colourBinding = 11,
                 lastPositionBinding = 12, objectBinding = 13;
} // namespace

void GpuScene::makeVertexArray() const {
    GLuint vao = 0;
    glCreateVertexArrays(1, &vao);
    vertexArray_ = Handle<destroyVertexArray>(vao);
    glObjectLabel(GL_VERTEX_ARRAY, vao, -1, "scene");
    const auto attribute = [&](GLuint location, const Buffer& buffer, GLint components, GLenum type, GLsizei stride) {
        glVertexArrayVertexBuffer(vao, location, buffer.name(), 0, stride);
        glVertexArrayAttribFormat(vao, location, components, type, type != GL_FLOAT, 0);
        glVertexArrayAttribBinding(vao, location, location);
        glEnableVertexArrayAttrib(vao, location);
    };
    attribute(positionBinding, positions_, 3, GL_FLOAT, sizeof(glm::vec3));
    attribute(normalBinding, normals_, 3, GL_FLOAT, sizeof(glm::vec3));
    attribute(uvBinding, uvs_, 2, GL_FLOAT, sizeof(glm::vec2));
    attribute(lastPositionBinding, positions_, 3, GL_FLOAT, sizeof(glm::vec3));
    if (hasColours()) attribute(colourBinding, colours_, 4, GL_UNSIGNED_SHORT, sizeof(glm::u16vec4));
    constexpr GLuint instanced = sizeof(DrawData) / sizeof(glm::vec4);
    static_assert(instancedBinding + instanced == colourBinding);
    glVertexArrayVertexBuffer(vao, instancedBinding, drawBuffer_.name(), 0, sizeof(DrawData));
    glVertexArrayBindingDivisor(vao, instancedBinding, 1);
    for (GLuint i = 0; i < instanced; ++i) {
        glVertexArrayAttribFormat(vao, instancedBinding + i, 4, GL_FLOAT, GL_FALSE, i * sizeof(glm::vec4));
        glVertexArrayAttribBinding(vao, instancedBinding + i, instancedBinding);
        glEnableVertexArrayAttrib(vao, instancedBinding + i);
    }
    attribute(objectBinding, objects_, 1, GL_FLOAT, sizeof(float));
    glVertexArrayBindingDivisor(vao, objectBinding, 1);
    glVertexArrayElementBuffer(vao, indices_.name());
}

void GpuScene::update(const SceneState& state) {
    if (state.posing()) {
        for (size_t i = 0; i < jointRows_.size(); ++i) jointRows_[i] = affineRows(state.pose().worldFromMesh[i]);
        if (!jointRows_.empty()) joints_.update(0, jointRows_.size() * sizeof(jointRows_[0]), jointRows_.data());
        const std::vector<float>& weights = state.pose().morphWeights;
        if (!weights.empty()) weights_.update(0, weights.size() * sizeof(float), weights.data());
    }
    // One frame after the last movement the previous matrices still have to catch up.
    if (sentVersion_ == state.poseVersion() && !sentMotion_) return;
    sentVersion_ = state.poseVersion();
    sentMotion_ = state.moving();
    for (size_t i = 0; i < draws_.size(); ++i) {
        const uint32_t drawable = drawableOfDraw_[i];
        if (drawable < state.drawables().size()) {
            const Drawable& d = state.drawables()[drawable];
            const Primitive& p = state.primitive(d);
            draws_[i].worldFromModel = affineRows(worldFromModel(state.pose(), *state.scene(), d.node, p));
            draws_[i].lastWorldFromModel = affineRows(worldFromModel(state.lastPose(), *state.scene(), d.node, p));
        } else {
            const uint32_t instances = state.ground() ? 1 : 0;
            if (instances)
                draws_[i].worldFromModel = draws_[i].lastWorldFromModel = affineRows(worldFromSquare(*state.ground()));
            commands_.update(groundCommand_ * sizeof(Command) + offsetof(Command, instances), sizeof(uint32_t),
                             &instances);
        }
    }
    drawBuffer_.update(0, draws_.size() * sizeof(DrawData), draws_.data());
}

void GpuScene::pose(const Program& program) const {
    const Buffer* const buffers[] = {&jobBuffer_,  &positions_, &normals_, &lastPositions_,
                                     &influences_, &deltas_,    &joints_,  &weights_};
    for (GLuint i = 0; i < std::size(buffers); ++i) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]->name());
    uint32_t largest = 0;
    for (const PoseJob& job : jobs_) largest = std::max(largest, job.vertexCount);
    constexpr uint32_t groupSize = 64; // of shaders/pose.glsl
    glUseProgram(program.name());
    glDispatchCompute((largest + groupSize - 1) / groupSize, static_cast<GLuint>(jobs_.size()), 1);
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void GpuScene::draw(const Draw& draw, const Programs& programs, size_t firstPiece, size_t pieces) const {
    if (!vertexArray_.get()) makeVertexArray();
    glBindVertexArray(vertexArray_.get());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());

    const auto textureUnit = [](const Program& program) {
        for (const Program::Binding& sampler : program.samplers())
            if (sampler.name == materialSampler) return static_cast<int>(sampler.unit);
        return -1;
    };
    const auto programOf = [&](const Batch& batch) -> const Program& {
        return batch.masked ? programs.masked : batch.texture >= 0 ? programs.textured : programs.plain;
    };
    const auto culls = [&](const Batch& batch) {
        switch (draw.faces) {
        case Faces::Casting: return !batch.doubleSided && !batch.closed;
        case Faces::Both: return false;
        case Faces::Shown: return !batch.doubleSided;
        case Faces::Nearest: return !batch.doubleSided || batch.closed;
        default: return true;
        }
    };
    // Batches that this pass cannot tell apart go in one call.
    for (size_t i = 0; i < batches_.size();) {
        const Batch& batch = batches_[i];
        const Program& program = programOf(batch);
        const int unit = textureUnit(program);
        size_t end = i, lastCommand = batch.firstCommand;
        const auto alike = [&](const Batch& other) {
            return other.casts == batch.casts && other.posed == batch.posed && &programOf(other) == &program &&
                   (unit < 0 || other.texture == batch.texture) && culls(other) == culls(batch) &&
                   (!culls(batch) || other.mirrored == batch.mirrored);
        };
        for (; end < batches_.size() && alike(batches_[end]); ++end) lastCommand += batches_[end].commandCount;
        i = end;
        const size_t firstCommand = std::max<size_t>(batch.firstCommand, firstPiece);
        lastCommand = std::min(lastCommand, firstPiece + pieces);
        if ((draw.castersOnly && !batch.casts) || firstCommand >= lastCommand) continue;

        if (unit >= 0) {
            const size_t texture = batch.texture >= 0 ? static_cast<size_t>(batch.texture) : textures_.size() - 1;
            glBindTextureUnit(static_cast<GLuint>(unit), textures_[texture].get());
            glBindSampler(static_cast<GLuint>(unit), 0);
        }
        glVertexArrayVertexBuffer(vertexArray_.get(), lastPositionBinding,
                                  (batch.posed ? lastPositions_ : positions_).name(), 0, sizeof(glm::vec3));
        culls(batch) ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
        glCullFace(draw.faces == Faces::Back ? GL_FRONT : GL_BACK);
        glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
        glUseProgram(program.name());
        glMultiDrawElementsIndirect(
            GL_TRIANGLES, GL_UNSIGNED_INT,
            reinterpret_cast<const void*>(static_cast<uintptr_t>(firstCommand * sizeof(Command))),
            static_cast<GLsizei>(lastCommand - firstCommand), 0);
    }
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

} // namespace penumbra
