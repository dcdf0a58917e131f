// SPDX-License-Identifier: MIT
#include "tests/support/scenes.h"

#include "renderer/scene/closed_surface.h"

#include <cmath>

namespace penumbra::test {
namespace {

HeadlessContext& context() {
    static HeadlessContext made;
    return made;
}

size_t forgotten = 0; // driver messages that a test has asked for

} // namespace

Renderer& renderer() {
    context();
    static Renderer made;
    return made;
}

std::vector<std::string> driverMessages() {
    const std::vector<std::string>& all = context().messages();
    return {all.begin() + static_cast<std::ptrdiff_t>(forgotten), all.end()};
}

void forgetDriverMessages() { forgotten = context().messages().size(); }

SceneBuilder& SceneBuilder::triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    Primitive primitive{.firstIndex = static_cast<uint32_t>(scene_.indices.size()),
                        .indexCount = 3,
                        .firstVertex = static_cast<uint32_t>(scene_.positions.size()),
                        .vertexCount = 3};
    const glm::vec3 cross = glm::cross(b - a, c - a);
    const float length = glm::length(cross);
    uint32_t index = 0;
    for (const glm::vec3 p : {a, b, c}) {
        scene_.positions.push_back(p);
        scene_.normals.push_back(length > 0 ? cross / length : glm::vec3(0, 1, 0));
        scene_.uvs.push_back({});
        scene_.indices.push_back(index++);
        primitive.bounds.add(p);
    }
    Node node;
    node.mesh = static_cast<int>(scene_.meshes.size());
    scene_.meshes.push_back({"triangle", {primitive}});
    scene_.nodes.push_back(node);
    return *this;
}

SceneBuilder& SceneBuilder::quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    return triangle(a, b, c).triangle(a, c, d);
}

SceneBuilder& SceneBuilder::floor(float h, float tiltDegrees) {
    const float c = std::cos(glm::radians(tiltDegrees)), s = std::sin(glm::radians(tiltDegrees));
    const auto at = [&](float x, float z) { return glm::vec3(x, -s * z, c * z); };
    return quad(at(-h, h), at(h, h), at(h, -h), at(-h, -h));
}

SceneBuilder& SceneBuilder::box(glm::vec3 a, glm::vec3 b) {
    quad({a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}); // top
    quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}); // bottom
    quad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    quad({b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z});
    quad({b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z});
    return quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
}

std::shared_ptr<const Scene> SceneBuilder::build() const {
    auto scene = std::make_shared<Scene>(scene_);
    scene->materials.push_back({.doubleSided = true});
    return scene;
}

SceneBuilder& SceneBuilder::twice() {
    const size_t n = scene_.positions.size();
    return triangle(scene_.positions[n - 3], scene_.positions[n - 2], scene_.positions[n - 1]);
}

std::shared_ptr<const Scene> SceneBuilder::merged() const {
    auto scene = std::make_shared<Scene>(*build());
    Primitive all{.indexCount = static_cast<uint32_t>(scene->indices.size()),
                  .vertexCount = static_cast<uint32_t>(scene->positions.size())};
    for (const glm::vec3 p : scene->positions) all.bounds.add(p);
    for (uint32_t i = 0; i < all.indexCount; ++i) scene->indices[i] = i;
    all.closed = isClosedSurface(*scene, all);
    scene->meshes = {{"merged", {all}}};
    scene->nodes.resize(1);
    return scene;
}

std::shared_ptr<Scene> wavingScene() {
    auto scene = std::make_shared<Scene>(*SceneBuilder().floor(3).box({0.9f, 0, -0.3f}, {1.4f, 0.5f, 0.3f}).build());
    // The board: along x from −1.5 m to 0.5 m, two rows of vertices, 1 m above the floor.
    constexpr uint32_t columns = 9;
    Primitive board{.firstIndex = static_cast<uint32_t>(scene->indices.size()),
                    .firstVertex = static_cast<uint32_t>(scene->positions.size()),
                    .vertexCount = 2 * columns,
                    .influenceSets = 1,
                    .morphTargets = 1};
    Bounds fixed, bent, bulge;
    for (uint32_t i = 0; i < columns; ++i)
        for (const float z : {-0.4f, 0.4f}) {
            const float along = static_cast<float>(i) / (columns - 1), x = -1.5f + 2 * along;
            const glm::vec3 p(x, 1, z), out(0, 0.3f * std::sin(3.14159f * along), 0);
            scene->positions.push_back(p);
            scene->normals.emplace_back(0, 1, 0);
            scene->uvs.emplace_back(0);
            scene->influences.push_back({.joints = glm::u16vec4(0, 1, 0, 0), .weights = {1 - along, along, 0, 0}});
            scene->morphDeltas.push_back({.position = out});
            if (along < 1) fixed.add(p);
            if (along > 0) bent.add(p);
            bulge.add(out);
            board.bounds.add(p);
        }
    for (uint32_t i = 0; i + 1 < columns; ++i)
        for (const uint32_t corner : {0u, 1u, 3u, 0u, 3u, 2u}) scene->indices.push_back(2 * i + corner);
    board.indexCount = static_cast<uint32_t>(scene->indices.size()) - board.firstIndex;
    board.jointBounds = {{0, fixed}, {1, bent}};
    board.morphBounds = {bulge};
    scene->meshes.push_back({"board", {board}});

    const int first = static_cast<int>(scene->nodes.size());
    Node root, tip, shown;
    tip.parent = first;
    tip.translation = {0.5f, 1, 0};
    shown.mesh = static_cast<int>(scene->meshes.size()) - 1;
    shown.skin = 0;
    scene->nodes.insert(scene->nodes.end(), {root, tip, shown});
    Skin skin{.joints = {first, first + 1}, .jointFromMesh = {glm::mat4(1), glm::mat4(1)}};
    skin.jointFromMesh[1][3] = {-0.5f, -1, 0, 1};
    scene->skins.push_back(skin);
    scene->restWeights = {0};
    const float s = std::sin(0.4f), c = std::cos(0.4f);
    scene->animations.push_back({.name = "wave",
                                 .duration = 1,
                                 .channels = {{.node = first + 1,
                                               .path = AnimationChannel::Path::Rotation,
                                               .width = 4,
                                               .times = {0, 0.5f, 1},
                                               .values = {0, 0, 0, 1, 0, 0, s, c, 0, 0, 0, 1}},
                                              {.node = first + 2,
                                               .path = AnimationChannel::Path::Weights,
                                               .width = 1,
                                               .times = {0, 0.5f, 1},
                                               .values = {0, 1, 0}}}});
    return scene;
}

Session session(std::shared_ptr<const Scene> scene, std::string_view technique) {
    Session s;
    s.scene = std::move(scene);
    s.camera = {.eye = {3, 2.5f, 3}, .target = {0, 0, 0}};
    s.light = {.position = {0, 4, 0}, .target = {0, 0, 0}, .size = {1, 1}};
    s.display.show = Show::Shadow;
    s.size = {64, 48};
    s.progressive = true; // a first frame
    s.techniques.choose(technique);
    return s;
}

Session quickSession(std::shared_ptr<const Scene> scene, std::string_view technique) {
    Session s = session(std::move(scene), technique);
    if (Parameter* size = s.techniques.parameters().find("map-size")) size->set(quickMap);
    return s;
}

glm::vec3 ShadowImage::positionWorld(int x, int y) const {
    const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(psi.height - 1 - y) + 0.5f;
    return view.eyeWorld + depth.values[index(x, y)] * (view.rayCorner + px * view.rayDx + py * view.rayDy);
}

double ShadowImage::meanOverSurface() const {
    double sum = 0, count = 0;
    for (int y = 0; y < psi.height; ++y)
        for (int x = 0; x < psi.width; ++x)
            if (surface(x, y)) sum += at(x, y), ++count;
    return sum / count;
}

ShadowImage draw(const Session& session) {
    Renderer& r = renderer();
    r.reset();
    r.render(session);
    const Image depth = *r.flow().find("scene.depth");
    return {r.read(r.shadow()), r.readPicture(depth), sessionView(session, r.state().bounds())};
}

} // namespace penumbra::test
