// SPDX-License-Identifier: MIT
// The ray-traced truth against what is known of it.
#include "renderer/truth/tracer.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"
#include "tests/truth/closed_forms.h"

#include <cmath>
#include <cstring>

using namespace penumbra;
using namespace penumbra::test;

namespace {

TruthInput inputOf(const Session& session) {
    renderer().reset();
    renderer().render(session);
    return readTruthInput(renderer(), session);
}

TruthSettings exactly(int samples) { return {.leastSamples = samples, .mostSamples = samples}; }

bool same(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

int count(const Truth& truth, PixelClass kind) {
    return static_cast<int>(std::count(truth.classes.begin(), truth.classes.end(), kind));
}

} // namespace

TEST_CASE("the closed form of a sphere under a disk has its published values") {
    // V of ../shared/algorithms.md 10.4, here ψ = 1 − V
    CHECK(1 - sphereUnderDisk(0.5, 0.2, 10, 6, {0, 0}) == Approx(0.5550611791).margin(1e-6));
    CHECK(1 - sphereUnderDisk(0.5, 0.2, 10, 6, {1, 0}) == Approx(0.9280735858).margin(1e-6));
    CHECK(1 - sphereUnderDisk(0.5, 0.6, 10, 6, {1, 0}) == Approx(0.1371716844).margin(1e-6));
    CHECK(1 - sphereUnderDisk(0.5, 0.6, 10, 6, {0, 1.5}) == Approx(0.5410566396).margin(1e-6));
    CHECK(1 - sphereUnderDisk(0.2, 0.3, 3, 1, {0.3, 0.4}) == Approx(0.7746333661).margin(1e-6));
}

TEST_CASE("rays meet the closed forms within 0.01 everywhere with 4096 samples") {
    for (const ClosedForm& form : closedForms) {
        const TruthInput input = inputOf(closedFormSession(form, {160, 120}));
        const Truth truth = traceTruth(input, exactly(4096));
        double most = 0;
        int pixels = 0, penumbra = 0;
        for (size_t i = 0; i < truth.psi.size(); ++i) {
            const glm::vec3 position = positionWorld(input, i);
            if (truth.classes[i] != PixelClass::FacesWholeLight || !onKnownFloor(position)) continue;
            const double expected = form.psi(position);
            most = std::max(most, std::abs(truth.psi[i] - expected));
            ++pixels;
            penumbra += expected > 0.01 && expected < 0.99;
        }
        CAPTURE(form.scene, most);
        CHECK(pixels > 5000);
        CHECK(penumbra > 500);
        CHECK(most < 0.01);
        CHECK(truth.samplesLeast == 4096);
        CHECK(truth.samplesMost == 4096);
    }
}

TEST_CASE("what shafts tell is what rays tell") {
    struct View {
        const char* scene;
        LightShape shape;
        float size;
    };
    for (const View& view : {View{"courtyard", LightShape::Rectangle, 1}, View{"courtyard", LightShape::Directional, 5},
                             View{"overlapping-occluders", LightShape::Disk, 1}, View{"two-boxes", LightShape::Disk, 0},
                             View{"thin-slab", LightShape::Directional, 0}}) {
        Session s;
        s.setScene(std::make_shared<const Scene>(importGltf(findScene(view.scene))));
        s.light.shape = view.shape;
        if (view.size != 1) s.light.size = glm::vec2(view.size);
        s.size = {200, 150};
        const TruthInput input = inputOf(s);
        TruthSettings settings = exactly(256);
        const Truth with = traceTruth(input, settings);
        settings.shafts = false;
        const Truth rays = traceTruth(input, settings);
        int known = 0, asked = 0, lit = 0, different = 0;
        for (size_t i = 0; i < rays.psi.size(); ++i) {
            if (rays.standardError[i] == 0) continue;
            ++asked;
            different += with.psi[i] != rays.psi[i];
            lit += rays.psi[i] == 0;
            known += with.standardError[i] == 0;
        }
        CAPTURE(view.scene, asked, known, lit);
        CHECK(different == 0);
        CHECK(known > 0.8 * lit);
        CHECK(lit > asked / 10);
    }
}

TEST_CASE("the standard error says how far off the truth is") {
    // (ψ − exact) / error has Student's distribution of 7 degrees of freedom, whose root mean square is √(7/5) = 1.18.
    // With few samples shares are coarse and it is less.
    for (const ClosedForm& form : closedForms)
        for (const int samples : {256, 1024}) {
            const TruthInput input = inputOf(closedFormSession(form, {160, 120}));
            const Truth truth = traceTruth(input, exactly(samples));
            double squares = 0, errors = 0, claimed = 0;
            int pixels = 0;
            for (size_t i = 0; i < truth.psi.size(); ++i) {
                const glm::vec3 position = positionWorld(input, i);
                if (truth.classes[i] != PixelClass::FacesWholeLight || !onKnownFloor(position)) continue;
                const double expected = form.psi(position);
                if (expected < 0.01 || expected > 0.99) continue;
                const double error = truth.psi[i] - expected;
                squares += std::pow(error / truth.standardError[i], 2);
                errors += error * error;
                claimed += truth.standardError[i] * truth.standardError[i];
                ++pixels;
            }
            const double ratio = std::sqrt(squares / pixels);
            CAPTURE(form.scene, samples, pixels, ratio, std::sqrt(errors / pixels), std::sqrt(claimed / pixels));
            CHECK(ratio > 0.7);
            CHECK(ratio < 1.4);
            CHECK(std::sqrt(errors / claimed) == Approx(1).margin(0.15));
        }
}

TEST_CASE("the spread of replicates and their unanimity give the error") {
    using Hidden = std::array<uint16_t, truthReplicates>;
    CHECK(estimateOf(Hidden{}, 256).psi == 0);
    CHECK(estimateOf(Hidden{}, 256).standardError == Approx(1.0 / 258));
    CHECK(estimateOf({32, 32, 32, 32, 32, 32, 32, 32}, 256).psi == 1);
    CHECK(estimateOf({32, 32, 32, 32, 32, 32, 32, 32}, 256).standardError == Approx(1.0 / 258));
    CHECK(estimateOf({8, 8, 8, 8, 8, 8, 8, 8}, 256).standardError == Approx(1.0 / 258));
    // Half of them 10 of 32, half 6: mean ¼, deviation of a replicate √(8/7) 2/32
    const Estimate e = estimateOf({10, 6, 10, 6, 10, 6, 10, 6}, 256);
    CHECK(e.psi == 0.25f);
    CHECK(e.standardError == Approx(std::sqrt(8 / 7.0) * 2 / 32 / std::sqrt(8.0) / 0.96503));
}

TEST_CASE("refinement ends below the wanted error, and goes where the error is") {
    const TruthInput input = inputOf(closedFormSession(closedForms[2], {160, 120}));
    const Truth coarse = traceTruth(input, exactly(256));
    const Truth fine = traceTruth(input, {.leastSamples = 256, .mostSamples = 16384, .wantedStandardError = 0.002});
    CHECK(coarse.meanPenumbraStandardError > 0.002);
    CHECK(fine.meanPenumbraStandardError < 0.002);
    CHECK(fine.meanPenumbraStandardError > 0.001); // and soon after it got there
    CHECK(fine.samplesLeast == 256);
    CHECK(fine.samplesMost > 512);
    CHECK(fine.samplesMean < 0.25 * fine.samplesMost);
    CHECK(fine.complete);

    double squares = 0;
    int pixels = 0;
    for (size_t i = 0; i < fine.psi.size(); ++i) {
        const glm::vec3 position = positionWorld(input, i);
        if (fine.classes[i] != PixelClass::FacesWholeLight || !onKnownFloor(position) || !fine.isPenumbra(i)) continue;
        squares += std::pow(fine.psi[i] - spherePsi(position), 2);
        ++pixels;
    }
    // The error itself, not only what is said of it; the root mean square is above the mean.
    CHECK(std::sqrt(squares / pixels) < 0.0025);
}

TEST_CASE("the same truth to the last bit on any number of threads, another for another seed") {
    Session s = closedFormSession(closedForms[2], {80, 60});
    TruthInput input = inputOf(s);
    TruthSettings settings{.leastSamples = 64, .mostSamples = 1024, .wantedStandardError = 0.004, .threads = 1};
    const Truth one = traceTruth(input, settings);
    settings.threads = 3;
    settings.background = true;
    const Truth three = traceTruth(input, settings);
    CHECK(same(one.psi, three.psi));
    CHECK(same(one.standardError, three.standardError));
    CHECK(one.classes == three.classes);
    CHECK(one.hash == three.hash);
    input.seed = 1;
    const Truth other = traceTruth(input, settings);
    CHECK_FALSE(same(one.psi, other.psi));
    CHECK(one.hash != other.hash);
}

TEST_CASE("the hash knows everything that the truth depends on") {
    Session s = session(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build());
    s.size = {8, 8};
    const TruthSettings settings = exactly(16);
    const auto hash = [&] { return traceTruth(inputOf(s), settings).hash; };
    const uint64_t first = hash();
    CHECK(hash() == first);
    std::vector<uint64_t> all{first};
    s.light.size.x = 1.5f, all.push_back(hash());
    s.light.position.x = 0.1f, all.push_back(hash());
    s.light.shape = LightShape::Disk, all.push_back(hash());
    s.camera.eye.x += 0.1f, all.push_back(hash());
    s.seed = 7, all.push_back(hash());
    s.scene = SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1.25f, 0}).build(), all.push_back(hash());
    TruthSettings more = settings;
    more.leastSamples = more.mostSamples = 32;
    all.push_back(traceTruth(inputOf(s), more).hash);
    std::sort(all.begin(), all.end());
    CHECK(std::unique(all.begin(), all.end()) == all.end());
}

TEST_CASE("no surface shadows itself, at any size, distance and slope") {
    for (const float scale : {1e-3f, 1.0f, 1e3f})
        for (const float away : {0.0f, 10.0f}) // times the scale: where coordinates are coarse
            for (const float tilt : {0.0f, 45.0f, 80.0f}) {
                const auto scene = [&] {
                    auto moved = std::make_shared<Scene>(*SceneBuilder().floor(3 * scale, tilt).build());
                    for (glm::vec3& p : moved->positions) p += away * scale;
                    for (Mesh& mesh : moved->meshes)
                        for (Primitive& primitive : mesh.primitives)
                            primitive.bounds = {primitive.bounds.min + away * scale,
                                                primitive.bounds.max + away * scale};
                    return moved;
                }();
                for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
                    Session s = session(scene);
                    const glm::vec3 middle(away * scale);
                    s.camera = {.eye = middle + scale * glm::vec3(3, 2.5f, 3), .target = middle};
                    s.light = {.shape = shape,
                               .position = middle + scale * glm::vec3(0, 4, 0.5f),
                               .target = middle,
                               .size = shape == LightShape::Directional ? glm::vec2(5) : glm::vec2(scale)};
                    const Truth truth = traceTruth(inputOf(s), exactly(128));
                    CAPTURE(scale, away, tilt, int(shape));
                    CHECK(count(truth, PixelClass::FacesWholeLight) > 300);
                    double most = 0;
                    for (size_t i = 0; i < truth.psi.size(); ++i)
                        if (truth.classes[i] == PixelClass::FacesWholeLight)
                            most = std::max<double>(most, truth.psi[i]);
                    CHECK(most == 0);
                }
            }
}

TEST_CASE("a ball shadows the floor, not its own lit side; a closed lid lets nothing through") {
    Session s = closedFormSession(closedForms[2], {160, 120});
    s.camera = {.eye = {1.5f, 8.5f, 1.5f}, .target = {0, 6, 0}, .fovY = 30};
    const TruthInput input = inputOf(s);
    const Truth truth = traceTruth(input, exactly(256));
    double most = 0;
    int pixels = 0;
    for (size_t i = 0; i < truth.psi.size(); ++i) {
        if (truth.classes[i] != PixelClass::FacesWholeLight || positionWorld(input, i).y < 5) continue;
        most = std::max<double>(most, truth.psi[i]);
        ++pixels;
    }
    CHECK(pixels > 2000);
    CHECK(most == 0);

    for (const LightShape shape : {LightShape::Rectangle, LightShape::Directional}) {
        Session lid = session(SceneBuilder().floor(2).box({-6, 2.2f, -6}, {6, 2.4f, 6}).build());
        lid.camera = {.eye = {1.5f, 1.2f, 1.5f}, .target = {0, 0, 0}, .fovY = 30};
        lid.light.shape = shape;
        const Truth dark = traceTruth(inputOf(lid), exactly(256));
        CHECK(count(dark, PixelClass::FacesWholeLight) > 1000);
        for (size_t i = 0; i < dark.psi.size(); ++i)
            if (dark.classes[i] == PixelClass::FacesWholeLight) REQUIRE(dark.psi[i] == 1);
    }
}

TEST_CASE("pixels are told apart by how they stand to the light") {
    // A box: its top faces the light, its sides are cut by the light's overhang, its bottom faces away.
    Session s = session(SceneBuilder().box({-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}).build());
    s.light.size = {4, 4};
    s.size = {128, 96};
    const TruthInput input = inputOf(s);
    const Truth truth = traceTruth(input, exactly(1024));
    CHECK(count(truth, PixelClass::NoSurface) > 100);
    CHECK(count(truth, PixelClass::FacesWholeLight) > 50);
    CHECK(count(truth, PixelClass::CutByHorizon) > 100);
    CHECK(count(truth, PixelClass::FacesAway) == 0);
    int cut = 0;
    for (size_t i = 0; i < truth.psi.size(); ++i) {
        const glm::vec3 position = positionWorld(input, i), normal = normalWorld(input, i);
        if (truth.classes[i] == PixelClass::NoSurface) CHECK(truth.psi[i] == 0);
        if (truth.classes[i] == PixelClass::CutByHorizon && std::abs(normal.x) > 0.99f) {
            // The side at x = 0.4 sees the light's x in [0.4, 2] of [−2, 2].
            CHECK(position.x == Approx(0.4f).margin(1e-4));
            CHECK(truth.psi[i] == Approx(0.6).margin(0.01));
            ++cut;
        }
    }
    CHECK(cut > 100);

    s.camera.eye = {3, -2.5f, 3};
    s.light.size = {0.5f, 0.5f};
    const Truth below = traceTruth(inputOf(s), exactly(16));
    CHECK(count(below, PixelClass::FacesAway) > 100);
    for (size_t i = 0; i < below.psi.size(); ++i)
        if (below.classes[i] == PixelClass::FacesAway) CHECK(below.psi[i] == 1);

    Session floor = session(SceneBuilder().floor(3).build());
    floor.light.position = {0, 2, 0}, floor.light.target = {0, 4, 0}; // looks up
    CHECK(count(traceTruth(inputOf(floor), exactly(16)), PixelClass::BehindLight) > 1000);
}

TEST_CASE("a directional light's edge is a disk's share") {
    // Edge at height h: ψ over |x| < h tan δ is the share of the disk on one side of a line.
    Session s = closedFormSession(closedForms[0], {160, 120});
    s.light.shape = LightShape::Directional;
    s.light.size = {10, 0};
    const TruthInput input = inputOf(s);
    const Truth truth = traceTruth(input, exactly(4096));
    double most = 0;
    int pixels = 0;
    for (size_t i = 0; i < truth.psi.size(); ++i) {
        const glm::vec3 position = positionWorld(input, i);
        if (truth.classes[i] != PixelClass::FacesWholeLight || !onKnownFloor(position)) continue;
        const double h = position.x < 0 ? 5.99 : 6; // of the slab's edge that a ray leaves last
        const double t = std::clamp(position.x / (h * std::tan(glm::radians(5.0))), -1.0, 1.0);
        most = std::max(most, std::abs(truth.psi[i] - (std::acos(t) - t * std::sqrt(1 - t * t)) / M_PI));
        ++pixels;
    }
    CHECK(pixels > 5000);
    CHECK(most < 0.01);
}

TEST_CASE("a sheet casts from the side that it shows, for rays as in maps") {
    // Over the floor: at x < 0 a sheet that faces the light, at x > 0 one that turns its back on it.
    const auto sheets = [](bool doubleSided, bool masked, bool mirrored) {
        auto scene = std::make_shared<Scene>(*SceneBuilder()
                                                  .quad({-2, 1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-2, 1, -1})
                                                  .quad({1, 1, -1}, {2, 1, -1}, {2, 1, 1}, {1, 1, 1})
                                                  .floor(3)
                                                  .build());
        scene->materials.push_back({.masked = masked, .doubleSided = doubleSided});
        for (size_t node = 0; node < 4; ++node) {
            scene->meshes[node].primitives[0].material = 1;
            if (mirrored) scene->nodes[node].scale.x = -1;
        }
        return scene;
    };
    const auto shareHidden = [](const std::vector<float>& psi, const TruthInput& input, bool left) {
        int pixels = 0;
        double sum = 0;
        for (size_t i = 0; i < psi.size(); ++i) {
            const glm::vec3 p = positionWorld(input, i);
            if (input.depth[i] <= 0 || std::abs(p.y) > 1e-3f || std::abs(p.z) > 0.8f) continue;
            if (const float x = left ? -p.x : p.x; x < 1.2f || x > 1.8f) continue;
            ++pixels, sum += psi[i];
        }
        REQUIRE(pixels > 50);
        return sum / pixels;
    };
    for (const bool doubleSided : {false, true})
        for (const bool masked : {false, true})
            for (const bool mirrored : {false, true}) {
                CAPTURE(doubleSided, masked, mirrored);
                Session s = session(sheets(doubleSided, masked, mirrored));
                s.light = {
                    .shape = LightShape::Directional, .position = {0, 9, 0}, .target = {0, 0, 0}, .size = {0, 0}};
                s.camera = {.eye = {0, 0.9f, 5}, .target = {0, 0, 0}, .fovY = 60};
                s.size = {200, 150};
                const TruthInput input = inputOf(s);
                // To a mirror, left is right, and a sheet that faced up still does.
                const bool facing = !mirrored;
                for (const std::vector<float>& psi : {traceTruth(input, exactly(16)).psi, draw(s).psi.values}) {
                    CHECK(shareHidden(psi, input, facing) > 0.99);
                    CHECK(shareHidden(psi, input, !facing) == Approx(doubleSided ? 1 : 0).margin(0.01));
                }
            }
}

namespace {

// A floor under a plate of 8 x 8 m at height 2 whose texture hides only some of it, seen by a light of a thousandth of
// a degree: ψ is 0 or 1.
std::shared_ptr<Scene> maskedPlate(const TextureImage& texture) {
    auto scene =
        std::make_shared<Scene>(*SceneBuilder().quad({-4, 2, 4}, {4, 2, 4}, {4, 2, -4}, {-4, 2, -4}).floor(3).build());
    scene->materials.push_back({.texture = 0, .masked = true, .doubleSided = true});
    scene->textures.push_back(texture);
    for (size_t i = 0; i < 6; ++i) // u along x, v along z, from 0 to 1 over the plate
        scene->uvs[i] = {(scene->positions[i].x + 4) / 8, (scene->positions[i].z + 4) / 8};
    scene->meshes[0].primitives[0].material = scene->meshes[1].primitives[0].material = 1;
    return scene;
}

// Compares with `hides`, of the plate's u and v, a little away from where it changes.
void checkMask(const std::shared_ptr<const Scene>& scene, bool (*hides)(float u, float v)) {
    Session s = session(scene);
    s.light = {.shape = LightShape::Directional, .position = {0, 9, 0}, .target = {0, 0, 0}, .size = {1e-3f, 0}};
    s.camera = {.eye = {2, 1.5f, 2}, .target = {0, 0, 0}, .fovY = 60};
    const TruthInput input = inputOf(s);
    const Truth truth = traceTruth(input, exactly(16));
    int hidden = 0, lit = 0, wrong = 0;
    for (size_t i = 0; i < truth.psi.size(); ++i) {
        const glm::vec3 p = positionWorld(input, i);
        if (truth.classes[i] != PixelClass::FacesWholeLight || std::abs(p.y) > 1e-3f) continue;
        const float u = (p.x + 4) / 8, v = (p.z + 4) / 8, step = 2e-3f;
        const bool expected = hides(u, v);
        bool clear = true;
        for (const float du : {-step, step})
            for (const float dv : {-step, step}) clear = clear && hides(u + du, v + dv) == expected;
        if (!clear) continue;
        (expected ? hidden : lit)++;
        wrong += truth.psi[i] != (expected ? 1.0f : 0.0f);
    }
    CHECK(hidden > 200);
    CHECK(lit > 200);
    CHECK(wrong == 0);
}

TextureImage alphas(int width, int height, std::vector<uint8_t> values) {
    TextureImage image{.name = "mask", .width = width, .height = height};
    for (const uint8_t alpha : values) image.rgba.insert(image.rgba.end(), {255, 255, 255, alpha});
    return image;
}

} // namespace

TEST_CASE("holes of masked materials let light through, as shadow maps have it") {
    SECTION("texels of their own") {
        TextureImage image = alphas(4, 2, {255, 0, 255, 0, 0, 255, 0, 255});
        image.magnifyNearest = true;
        checkMask(maskedPlate(image),
                  [](float u, float v) { return (int(std::floor(u * 4)) + int(std::floor(v * 2))) % 2 == 0; });
    }
    SECTION("linear between texel centres") {
        // Along u: 0 at ¼, 1 at ¾, clamped beyond.
        TextureImage image = alphas(2, 1, {0, 255});
        image.wrapU = Wrap::ClampToEdge;
        auto scene = maskedPlate(image);
        scene->materials[1].alphaCutoff = 0.7f;
        checkMask(scene, [](float u, float) { return std::clamp((u - 0.25f) / 0.5f, 0.0f, 1.0f) >= 0.7f; });
    }
    SECTION("repeated and mirrored, below 0 too") {
        TextureImage image = alphas(4, 1, {255, 0, 0, 0});
        image.magnifyNearest = true;
        image.wrapU = Wrap::MirroredRepeat;
        auto scene = maskedPlate(image);
        for (size_t i = 0; i < 6; ++i) scene->uvs[i] = scene->uvs[i] * 6.0f - 3.0f;
        checkMask(scene, [](float u, float) {
            const float t = u * 6 - 3, within = t - 2 * std::floor(t / 2);
            return within < 0.25f || within >= 1.75f;
        });
    }
    SECTION("times the vertices' alpha and the factor") {
        auto scene = maskedPlate(alphas(1, 1, {255}));
        scene->colours.assign(scene->positions.size(), glm::u16vec4(65535));
        for (size_t i = 0; i < 6; ++i) scene->colours[i].a = static_cast<uint16_t>(65535 * scene->uvs[i].x);
        scene->materials[1].baseColour.a = 0.8f;
        checkMask(scene, [](float u, float) { return 0.8f * u >= 0.5f; });
    }
    SECTION("no mask, no holes") {
        auto scene = maskedPlate(alphas(1, 1, {0}));
        scene->materials[1].masked = false;
        Session s = session(scene);
        s.light.shape = LightShape::Directional;
        s.camera = {.eye = {2, 1.5f, 2}, .target = {0, 0, 0}, .fovY = 60};
        const Truth truth = traceTruth(inputOf(s), exactly(16));
        for (size_t i = 0; i < truth.psi.size(); ++i)
            if (truth.classes[i] == PixelClass::FacesWholeLight) REQUIRE(truth.psi[i] == 1);
    }
}

TEST_CASE("what moves casts from where it is") {
    const auto still = [](float x) { return SceneBuilder().floor(3).box({-1 + x, 1, -1}, {x, 1.5f, 0}).build(); };
    Session s = session(still(0.75f));
    s.size = {32, 24};
    const Truth expected = traceTruth(inputOf(s), exactly(64));

    SECTION("by its node") {
        auto scene = std::make_shared<Scene>(*still(0));
        for (size_t n = 2; n < scene->nodes.size(); ++n) scene->nodes[n].translation = {0.75f, 0, 0};
        s.scene = scene;
    }
    SECTION("by a morph target") {
        auto scene = std::make_shared<Scene>(*still(0));
        for (size_t n = 2; n < scene->nodes.size(); ++n) {
            Primitive& primitive = scene->meshes[n].primitives[0];
            primitive.morphTargets = 1;
            primitive.firstDelta = static_cast<uint32_t>(scene->morphDeltas.size());
            primitive.morphBounds = {{glm::vec3(1.5f, 0, 0), glm::vec3(1.5f, 0, 0)}};
            for (int v = 0; v < 3; ++v) scene->morphDeltas.push_back({.position = {1.5f, 0, 0}});
            scene->nodes[n].firstWeight = static_cast<uint32_t>(scene->restWeights.size());
            scene->restWeights.push_back(0.5f);
        }
        s.scene = scene;
    }
    const Truth moved = traceTruth(inputOf(s), exactly(64));
    double most = 0;
    for (size_t i = 0; i < moved.psi.size(); ++i)
        most = std::max<double>(most, std::abs(moved.psi[i] - expected.psi[i]));
    CHECK(most < 0.02); // vertices round differently, so a ray may
    CHECK(expected.penumbraPixels > 50);
}

TEST_CASE("what does not belong to the scene does not cast") {
    SECTION("the ground") {
        Session s = session(SceneBuilder().box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}).build());
        s.ground = true;
        s.light.position = {0, -3, 0}, s.light.target = {0, 0, 0}; // from below the ground
        s.camera.eye = {0.5f, -0.02f, 0.5f};
        s.camera.target = {0, 0, 0};
        const Truth truth = traceTruth(inputOf(s), exactly(16));
        CHECK(count(truth, PixelClass::FacesWholeLight) > 100);
    }
    SECTION("an invisible node") {
        auto scene = std::make_shared<Scene>(*SceneBuilder().floor(3).box({-6, 2, -6}, {6, 2.5f, 6}).build());
        for (size_t n = 2; n < scene->nodes.size(); ++n) scene->nodes[n].visible = false;
        Session s = session(scene);
        const Truth truth = traceTruth(inputOf(s), exactly(16));
        for (const float psi : truth.psi) REQUIRE(psi == 0);
    }
}

TEST_CASE("odd scenes and lights have a truth too") {
    const auto checkSane = [](const Session& s) {
        const Truth truth = traceTruth(inputOf(s), exactly(32));
        REQUIRE(truth.psi.size() == static_cast<size_t>(s.size.x * s.size.y));
        for (size_t i = 0; i < truth.psi.size(); ++i) {
            REQUIRE((truth.psi[i] >= 0 && truth.psi[i] <= 1));
            REQUIRE((truth.standardError[i] >= 0 && truth.standardError[i] < 1));
        }
    };
    checkSane(session(SceneBuilder().build()));
    SceneBuilder degenerate;
    degenerate.floor(3).triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}).triangle({0, 1, 0}, {1, 1, 0}, {2, 1, 0});
    checkSane(session(degenerate.build()));
    Session s = session(SceneBuilder().floor(3).box({-1, 0, -1}, {0, 1, 0}).build());
    for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
        s.light.shape = shape;
        for (const float size : {0.0f, 1e-6f, 100.0f}) {
            s.light.size = glm::vec2(size);
            checkSane(s);
        }
    }
    s.size = {1, 1};
    checkSane(s);
    s.light.position = s.light.target;
    checkSane(s);
}
