// SPDX-License-Identifier: MIT
#include "renderer/scene/gpu_scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
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
constexpr glm::vec4 groundColour{0.5f, 0.5f, 0.5f, 1};

glm::mat4 worldFromSquare(const Ground& ground) {
    const glm::mat4 moved = glm::translate(glm::mat4(1), {ground.centre.x, ground.height, ground.centre.y});
    return glm::scale(moved, glm::vec3(ground.halfSize, 1, ground.halfSize));
}

// The upper three rows of a matrix whose last row is 0 0 0 1.
glm::mat3x4 affineRows(const glm::mat4& matrix) { return glm::mat3x4(glm::transpose(matrix)); }

} // namespace

GpuScene::TextureHandle GpuScene::upload(const TextureImage& image) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    TextureHandle handle(name);
    const int levels = std::bit_width(static_cast<unsigned>(std::max(image.width, image.height)));
    glTextureStorage2D(name, levels, GL_SRGB8_ALPHA8, image.width, image.height);
    glTextureSubImage2D(name, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    glGenerateTextureMipmap(name);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, glWrap(image.wrapU));
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, glWrap(image.wrapV));
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, image.magnifyNearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glObjectLabel(GL_TEXTURE, name, static_cast<GLsizei>(std::min<size_t>(image.name.size(), 200)), image.name.data());
    return handle;
}

GpuScene::GpuScene(const SceneState& state) {
    const Scene& scene = *state.scene();

    // The scene's vertices, then the square of the ground.
    const size_t vertices = scene.positions.size(), indexCount = scene.indices.size();
    groundVertices_ = static_cast<uint32_t>(vertices);
    const auto joined = [](std::string_view label, const auto& own, const auto& extra) {
        const size_t bytes = own.size() * sizeof(own[0]), extraBytes = std::size(extra) * sizeof(extra[0]);
        Buffer buffer(label, bytes + extraBytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
        if (bytes) buffer.update(0, bytes, own.data());
        buffer.update(bytes, extraBytes, std::data(extra));
        return buffer;
    };
    const std::vector<glm::vec3> squareNormals(4, glm::vec3(0, 1, 0));
    const std::vector<glm::vec2> squareUvs(4, glm::vec2(0));
    positions_ = joined("positions", scene.positions, squarePositions);
    normals_ = joined("normals", scene.normals, squareNormals);
    uvs_ = joined("uvs", scene.uvs, squareUvs);
    indices_ = joined("indices", scene.indices, squareIndices);

    // Commands in an order that makes long batches: all opaque casters stand together.
    struct Keyed {
        uint32_t drawable;
        Batch batch;
    };
    std::vector<Keyed> order;
    for (uint32_t i = 0; i < state.drawables().size(); ++i) {
        const Drawable& d = state.drawables()[i];
        const Primitive& primitive = scene.meshes[d.mesh].primitives[d.primitive];
        const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
        const bool mirrored = glm::determinant(glm::mat3(state.pose().worldFromNode[d.node])) < 0;
        order.push_back({i, {0, 1, material.texture, material.masked, material.doubleSided, mirrored, true, d.closed}});
    }
    order.push_back({static_cast<uint32_t>(state.drawables().size()), {0, 1, -1, false, true, false, false, false}});
    const auto key = [](const Batch& b) {
        return std::tuple(!b.casts, b.masked, b.texture, b.closed, b.doubleSided, b.mirrored);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Keyed& a, const Keyed& b) { return key(a.batch) < key(b.batch); });

    std::vector<Command> commands;
    for (const Keyed& keyed : order) {
        const uint32_t index = static_cast<uint32_t>(commands.size());
        DrawData data{affineRows(glm::mat4(1)), groundColour, glm::vec4(0), affineRows(glm::mat4(1))};
        if (keyed.drawable < state.drawables().size()) {
            const Drawable& d = state.drawables()[keyed.drawable];
            const Primitive& p = scene.meshes[d.mesh].primitives[d.primitive];
            const Material& material = scene.materials[static_cast<size_t>(p.material)];
            commands.push_back({p.indexCount, 1, p.firstIndex, static_cast<int32_t>(p.firstVertex), index});
            data.baseColour = material.baseColour;
            data.emissive_cutoff = glm::vec4(material.emissive, material.alphaCutoff);
        } else {
            commands.push_back({std::size(squareIndices), 0, static_cast<uint32_t>(indexCount),
                                static_cast<int32_t>(groundVertices_), index});
        }
        draws_.push_back(data);
        drawableOfCommand_.push_back(keyed.drawable);
        if (batches_.empty() || key(batches_.back()) != key(keyed.batch)) {
            batches_.push_back(keyed.batch);
            batches_.back().firstCommand = index;
        } else {
            ++batches_.back().commandCount;
        }
    }
    commands_ = Buffer("draw commands", commands.size() * sizeof(Command), commands.data(), GL_DYNAMIC_STORAGE_BIT);
    drawBuffer_ = Buffer("draws", draws_.size() * sizeof(DrawData), draws_.data(), GL_DYNAMIC_STORAGE_BIT);

    GLuint vao = 0;
    glCreateVertexArrays(1, &vao);
    vertexArray_ = Handle<destroyVertexArray>(vao);
    glObjectLabel(GL_VERTEX_ARRAY, vao, -1, "scene");
    const auto attribute = [&](GLuint location, const Buffer& buffer, GLint components, GLsizei stride) {
        glVertexArrayVertexBuffer(vao, location, buffer.name(), 0, stride);
        glVertexArrayAttribFormat(vao, location, components, GL_FLOAT, GL_FALSE, 0);
        glVertexArrayAttribBinding(vao, location, location);
        glEnableVertexArrayAttrib(vao, location);
    };
    attribute(0, positions_, 3, sizeof(glm::vec3));
    attribute(1, normals_, 3, sizeof(glm::vec3));
    attribute(2, uvs_, 2, sizeof(glm::vec2));
    constexpr GLuint firstInstanced = 3, instanced = sizeof(DrawData) / sizeof(glm::vec4);
    glVertexArrayVertexBuffer(vao, firstInstanced, drawBuffer_.name(), 0, sizeof(DrawData));
    glVertexArrayBindingDivisor(vao, firstInstanced, 1);
    for (GLuint i = 0; i < instanced; ++i) {
        glVertexArrayAttribFormat(vao, firstInstanced + i, 4, GL_FLOAT, GL_FALSE, i * sizeof(glm::vec4));
        glVertexArrayAttribBinding(vao, firstInstanced + i, firstInstanced);
        glEnableVertexArrayAttrib(vao, firstInstanced + i);
    }
    glVertexArrayElementBuffer(vao, indices_.name());

    for (const TextureImage& image : scene.textures) textures_.push_back(upload(image));
    textures_.push_back(upload({.name = "white", .width = 1, .height = 1, .rgba = {255, 255, 255, 255}}));
    update(state);
}

void GpuScene::update(const SceneState& state) {
    // One frame after the last movement the previous matrices still have to catch up.
    if (sentVersion_ == state.poseVersion() && !sentMotion_) return;
    sentVersion_ = state.poseVersion();
    sentMotion_ = state.moving();
    for (size_t i = 0; i < draws_.size(); ++i) {
        const uint32_t drawable = drawableOfCommand_[i];
        if (drawable < state.drawables().size()) {
            const uint32_t node = state.drawables()[drawable].node;
            draws_[i].worldFromModel = affineRows(state.pose().worldFromNode[node]);
            draws_[i].lastWorldFromModel = affineRows(state.lastPose().worldFromNode[node]);
        } else {
            const uint32_t instances = state.ground() ? 1 : 0;
            if (instances)
                draws_[i].worldFromModel = draws_[i].lastWorldFromModel = affineRows(worldFromSquare(*state.ground()));
            commands_.update(i * sizeof(Command) + offsetof(Command, instances), sizeof(uint32_t), &instances);
        }
    }
    drawBuffer_.update(0, draws_.size() * sizeof(DrawData), draws_.data());
}

void GpuScene::draw(const Draw& draw, const Programs& programs) const {
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
        case Faces::Both: return false;
        case Faces::AsMaterial: return !batch.doubleSided;
        case Faces::Nearest: return batch.closed;
        default: return true;
        }
    };
    // Batches that this pass cannot tell apart go in one call.
    for (size_t i = 0; i < batches_.size();) {
        const Batch& batch = batches_[i];
        const Program& program = programOf(batch);
        const int unit = textureUnit(program);
        size_t end = i;
        uint32_t commands = 0;
        const auto alike = [&](const Batch& other) {
            return other.casts == batch.casts && &programOf(other) == &program &&
                   (unit < 0 || other.texture == batch.texture) && culls(other) == culls(batch) &&
                   (!culls(batch) || other.mirrored == batch.mirrored);
        };
        for (; end < batches_.size() && alike(batches_[end]); ++end) commands += batches_[end].commandCount;
        i = end;
        if (draw.castersOnly && !batch.casts) continue;

        if (unit >= 0) {
            const size_t texture = batch.texture >= 0 ? static_cast<size_t>(batch.texture) : textures_.size() - 1;
            glBindTextureUnit(static_cast<GLuint>(unit), textures_[texture].get());
            glBindSampler(static_cast<GLuint>(unit), 0);
        }
        culls(batch) ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
        glCullFace(draw.faces == Faces::Back ? GL_FRONT : GL_BACK);
        glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
        glUseProgram(program.name());
        glMultiDrawElementsIndirect(
            GL_TRIANGLES, GL_UNSIGNED_INT,
            reinterpret_cast<const void*>(static_cast<uintptr_t>(batch.firstCommand * sizeof(Command))),
            static_cast<GLsizei>(commands), 0);
    }
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
}

} // namespace penumbra
