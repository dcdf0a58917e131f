// SPDX-License-Identifier: MIT
#include "renderer/shadow_map/shadow_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra {
namespace {

using glm::vec3;

constexpr float nearestShare = 1e-4f;  // the near plane is never nearer than this share of the far one
constexpr size_t mostCompared = 64;    // boxes, each with each, for every map
constexpr float widestTangent = 5.67f; // a perspective map opens to 80° on either side of the axis

// An axis-aligned rectangle on the reference plane [m].
struct Window {
    vec2 min{1e30f}, max{-1e30f};
    bool empty() const { return min.x >= max.x || min.y >= max.y; }
    void add(vec2 p) { min = glm::min(min, p), max = glm::max(max, p); }
    Window intersected(const Window& o) const { return {glm::max(min, o.min), glm::min(max, o.max)}; }
};

// A space for fitting: light space with z turned into the axial depth d = −z.
vec3 fittingFromLight(vec3 p) { return {p.x, p.y, -p.z}; }
vec3 fittingFromWorld(vec3 p, const mat4& lightFromWorld) {
    return fittingFromLight(vec3(lightFromWorld * vec4(p, 1)));
}

// Points whose convex hull holds a thing: the corners of a box, or of what is left of it.
struct Corners {
    std::array<vec3, 64> points;
    size_t count = 0;
    void add(vec3 p) { points[count++] = p; }
    const vec3* begin() const { return points.data(); }
    const vec3* end() const { return points.data() + count; }
};

Corners cornersOf(const Bounds& box, const mat4& lightFromWorld) {
    Corners corners;
    for (int i = 0; i < 8; ++i)
        corners.add(fittingFromWorld(
            {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z},
            lightFromWorld));
    return corners;
}

// A convex region, n·P + w >= 0, and such corners of it as a box may hold within.
struct Region {
    std::array<vec4, 6> planes;
    size_t planeCount = 0;
    std::array<vec3, 4> tips;
    void bound(vec3 normal, vec3 through) { planes[planeCount++] = vec4(normal, -glm::dot(normal, through)); }
};

// What lies within of a box with these eight corners: mostly all of it or nothing. Else its faces, cut in turn by the
// planes that run through it (Sutherland and Hodgman 1974), and the region's tips if they are in the box.
Corners within(const Region& region, const Corners& box) {
    std::array<vec4, 6> cutting;
    size_t cuts = 0;
    for (const vec4& plane : std::span(region.planes).first(region.planeCount)) {
        const auto outside =
            std::count_if(box.begin(), box.end(), [&](vec3 p) { return glm::dot(plane, vec4(p, 1)) < 0; });
        if (outside == 8) return {};
        if (outside > 0) cutting[cuts++] = plane;
    }
    if (cuts == 0) return box;

    static constexpr size_t faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    Corners left;
    for (const auto& face : faces) {
        std::array<vec3, 10> polygon, cut; // each plane adds a corner at most
        size_t count = 0;
        for (const size_t i : face) polygon[count++] = box.points[i];
        for (const vec4& plane : std::span(cutting).first(cuts)) {
            size_t kept = 0;
            for (size_t i = 0; i < count; ++i) {
                const vec3 from = polygon[i], to = polygon[(i + 1) % count];
                const float a = glm::dot(plane, vec4(from, 1)), b = glm::dot(plane, vec4(to, 1));
                if (a >= 0) cut[kept++] = from;
                if ((a >= 0) != (b >= 0)) cut[kept++] = glm::mix(from, to, a / (a - b));
            }
            count = kept;
            std::swap(polygon, cut);
        }
        for (size_t i = 0; i < count; ++i) left.add(polygon[i]);
    }
    const vec3 x = box.points[1] - box.points[0], y = box.points[2] - box.points[0], z = box.points[4] - box.points[0];
    const vec3 most(glm::dot(x, x), glm::dot(y, y), glm::dot(z, z));
    for (const vec3& tip : region.tips) {
        const vec3 p = tip - box.points[0], along(glm::dot(p, x), glm::dot(p, y), glm::dot(p, z));
        // A flat box, with a side of no length, has no inside.
        if (glm::all(glm::greaterThan(along, vec3(0))) && glm::all(glm::lessThan(along, most))) left.add(tip);
    }
    return left;
}

// What a view can show, from its near plane on: a pyramid, or a box of parallel rays.
Region shownBy(const View& view, const mat4& lightFromWorld) {
    // The share of the picture's width and height, and the eye depth.
    const auto at = [&](vec2 share, float depth) {
        const vec2 pixel = share * vec2(view.size);
        const vec3 from = view.eyeWorld + pixel.x * view.eyeDx + pixel.y * view.eyeDy;
        const vec3 ray = view.rayCorner + pixel.x * view.rayDx + pixel.y * view.rayDy;
        return fittingFromWorld(from + depth * ray, lightFromWorld);
    };
    static constexpr vec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const vec3 inside = at(vec2(0.5f), 2 * view.near);
    Region region;
    for (size_t i = 0; i < 4; ++i) region.tips[i] = at(corners[i], view.near);
    const auto bound = [&](vec3 a, vec3 b, vec3 c) {
        const vec3 normal = glm::cross(b - a, c - a);
        region.bound(glm::dot(normal, inside - a) < 0 ? -normal : normal, a);
    };
    for (size_t i = 0; i < 4; ++i) bound(region.tips[i], region.tips[(i + 1) % 4], at(corners[i], 2 * view.near));
    bound(region.tips[0], region.tips[1], region.tips[2]);
    return region;
}

// What may stand between the light and a box of the fitting space.
Region before(const Bounds& box, vec2 halfLight, bool directional) {
    Region region;
    region.bound({0, 0, -1}, box.max);
    if (!directional) region.bound({0, 0, 1}, vec3(0));
    for (const int axis : {0, 1})
        for (const float side : {-1.0f, 1.0f}) {
            // The steepest line from an edge of the light past the box: side · p <= from + slope · d.
            const float half = halfLight[axis], edge = side < 0 ? -box.min[axis] : box.max[axis];
            const float d = edge > half ? box.min.z : box.max.z;
            const float slope = directional ? -half : (edge - half) / std::max(d, 1e-6f * box.max.z + 1e-30f);
            const float from = directional ? edge + half * box.max.z : half;
            vec3 normal(0, 0, slope), through(0);
            normal[axis] = -side;
            through[axis] = side * from;
            region.bound(normal, through);
        }
    for (int i = 0; i < 4; ++i)
        region.tips[size_t(i)] = vec3(halfLight * vec2(i & 1 ? 1 : -1, i & 2 ? 1 : -1), directional ? box.max.z : 0);
    return region;
}

struct MapFit {
    float near, far, reference; // axial depths
    Window window;
    float farthest = 1;     // from any point of the light
    glm::uvec4 needless{0}; // a bit for each of the first things: it shades neither itself nor another
};

// Where corners fall on the reference plane, from the point s of the light. Parts before the near plane are moved onto
// it, with the whole cross-section, which contains theirs.
Window project(const Corners& corners, const MapFit& fit, LightSample s, bool directional) {
    Window window;
    const bool straddles = std::any_of(corners.begin(), corners.end(), [&](vec3 c) { return c.z < fit.near; });
    const auto add = [&](vec2 xy, float d) {
        window.add(directional ? xy + s * (d - fit.reference) : s + (xy - s) * (fit.reference / d));
    };
    for (const vec3& c : corners) {
        if (straddles && !directional) add(vec2(c), fit.near);
        if (directional || c.z >= fit.near) add(vec2(c), c.z);
    }
    return window;
}

std::span<const Bounds> boxesOf(const Occluder& occluder) {
    return occluder.partsWorld.empty() ? std::span(&occluder.boundsWorld, 1) : occluder.partsWorld;
}

// Where the points of the light are: a box around them in the world or, if it is directional, of directions to them.
Bounds lightBounds(const AreaLight& light) {
    const mat4 worldFromLight = glm::inverse(lightFromWorld(light));
    const vec2 half = halfSize(light);
    Bounds bounds;
    for (const vec2 side : {vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1)})
        bounds.add(light.shape == LightShape::Directional ? vec3(worldFromLight * vec4(half * side, 1, 0))
                                                          : vec3(worldFromLight * vec4(half * side, 0, 1)));
    return bounds;
}

// Whether something that is shown may lie behind a thing in this box. It does not if a face of the box has both it and
// the light before it.
bool shadesOthers(const Occluder& caster, const Bounds& box, std::span<const Occluder> occluders,
                  const std::optional<Region>& shown, const mat4& fromWorld, const Bounds& points, bool directional) {
    const float slack = 1e-5f * box.diagonal();
    const auto before = [&](const Bounds& other, int axis) {
        const float low = box.min[axis] + slack, high = box.max[axis] - slack;
        const bool above = points.min[axis] >= (directional ? 0 : high),
                   below = points.max[axis] <= (directional ? 0 : low);
        return (above && other.min[axis] >= high) || (below && other.max[axis] <= low);
    };
    for (const Occluder& other : occluders) {
        if (&other == &caster) continue;
        for (const Bounds& part : boxesOf(other)) {
            if (before(part, 0) || before(part, 1) || before(part, 2)) continue;
            if (!shown || within(*shown, cornersOf(part, fromWorld)).count > 0) return true;
        }
    }
    return false;
}

// `view`: of receivers, only what it shows counts, and of casters, what may stand before that. A floor that lies behind
// everything, as seen from the light, takes no texels where nothing stands on it. The window is that of the point s.
MapFit fitMap(const AreaLight& light, std::span<const Occluder> occluders, const mat4& fromWorld, vec2 half,
              LightSample s, const View* view) {
    const bool directional = light.shape == LightShape::Directional;
    size_t boxes = 0, plain = 0;
    for (const Occluder& occluder : occluders) boxes += boxesOf(occluder).size(), plain += !occluder.shadesItself;
    const bool few = boxes * plain <= mostCompared;
    const auto eachBox = [&](auto&& take) {
        for (const Occluder& occluder : occluders)
            for (const Bounds& box : boxesOf(occluder)) take(cornersOf(box, fromWorld), occluder, box);
    };
    const std::optional<Region> shown = view ? std::optional(shownBy(*view, fromWorld)) : std::nullopt;
    std::optional<Region> between;
    if (shown) {
        Bounds seen;
        eachBox([&](const Corners& box, const Occluder&, const Bounds&) {
            for (const vec3& c : within(*shown, box)) seen.add(c);
        });
        if (!seen.empty() && (directional || seen.max.z > 0)) between = before(seen, half, directional);
    }
    float nearest = 1e30f, farthest = -1e30f, radius = 0;
    eachBox([&](const Corners& box, const Occluder& occluder, const Bounds&) {
        for (const vec3& c : box) {
            farthest = std::max(farthest, c.z);
            radius = std::max(radius, glm::length(c));
        }
        if (!occluder.casts) return;
        for (const vec3& c : between ? within(*between, box) : box) nearest = std::min(nearest, c.z);
    });
    MapFit fit{0, 1, 1, {{-1, -1}, {1, 1}}};
    const bool nothing = nearest > farthest || (!directional && farthest <= 0);
    if (nothing) return fit;

    const float slack = 1e-3f * std::max(farthest - nearest, 1e-6f * std::abs(farthest)) + 1e-20f;
    fit.far = farthest + slack;
    fit.near = directional ? nearest - slack : std::max(nearest - slack, nearestShare * fit.far);
    fit.far = std::max(fit.far, fit.near + slack);
    fit.reference = fit.far;
    fit.farthest = radius + glm::length(half) + slack;

    const auto beyondNear = [&](const Corners& corners) {
        return std::any_of(corners.begin(), corners.end(), [&](vec3 c) { return directional || c.z >= fit.near; });
    };
    const auto bit = [](int object) { return 1u << ((object - 1) % 32); };
    const auto known = [](int object) { return object > 0 && object <= int(8 * sizeof(glm::uvec4)); };
    glm::uvec4 shading(0);
    Window casters, receivers;
    const Bounds points = lightBounds(light);
    eachBox([&](const Corners& box, const Occluder& occluder, const Bounds& boxWorld) {
        const bool casts = occluder.casts && beyondNear(box);
        if (casts && (occluder.shadesItself || !few ||
                      shadesOthers(occluder, boxWorld, occluders, shown, fromWorld, points, directional))) {
            const Window window = project(box, fit, s, directional);
            casters.add(window.min), casters.add(window.max);
            if (known(occluder.object)) shading[(occluder.object - 1) / 32] |= bit(occluder.object);
        }
        const Corners seen = shown ? within(*shown, box) : box;
        if (!beyondNear(seen)) return;
        // A receiver may look at the whole light, past blockers that fall beside it on the reference plane: towards the
        // point l by (l − s) f (1/d_b − 1/d) or, directional, (l − s) (d − d_b).
        float d = -1e30f;
        for (const vec3& c : seen) d = std::max(d, c.z);
        const float aside = directional ? d - fit.near : fit.reference * (1 / fit.near - 1 / d);
        const Window window = project(seen, fit, s, directional);
        receivers.add(window.min - (half + s) * std::max(aside, 0.0f));
        receivers.add(window.max + (half - s) * std::max(aside, 0.0f));
    });
    for (const Occluder& occluder : occluders)
        if (few && known(occluder.object)) fit.needless[(occluder.object - 1) / 32] |= bit(occluder.object);
    fit.needless &= ~shading;
    fit.window = casters.intersected(receivers);
    if (!directional) {
        const vec2 widest(widestTangent * fit.reference);
        fit.window = fit.window.intersected({s - widest, s + widest});
    }
    if (fit.window.empty()) fit.window = {vec2(-1e-3f * fit.far), vec2(1e-3f * fit.far)};
    return fit;
}

// And what an averaged map leaves out.
std::pair<LightViewBlock, glm::uvec4> fittedView(const AreaLight& light, std::span<const Occluder> occluders,
                                                 const ShadowMapDescription& description, const View* view) {
    const LightSample s = description.sample;
    const int size = description.size;
    const bool directional = light.shape == LightShape::Directional, radial = description.metric != Metric::Axial;
    ensure(!(directional && radial), "a directional light has no point to measure radial depth from");
    const mat4 fromWorld = lightFromWorld(light);
    const vec2 half = halfSize(light);
    const MapFit fit = fitMap(light, occluders, fromWorld, half, s, description.fit == Fit::View ? view : nullptr);
    const float f = fit.reference;

    // A border of empty texels, whole after a shift too.
    vec2 side = fit.window.max - fit.window.min;
    const float longest = std::max(side.x, side.y);
    side = description.averaged ? glm::max(side, vec2(1e-3f * longest)) : vec2(longest);
    const int filled = size - 2 * description.border - (description.shift != vec2(0) ? 1 : 0);
    const vec2 h = side * (0.5f * static_cast<float>(size) / static_cast<float>(std::max(filled, 1)));
    const vec2 centre =
        0.5f * (fit.window.min + fit.window.max) + description.shift * (2.0f * h / static_cast<float>(size));

    // clip = M · light-space position, row by row; see shaders/shared/view.glsl.h for the map's coordinates.
    mat4 rows(0);
    if (directional) {
        // x = (P.x + s.x (d − f) − c.x) / h with d = −z
        rows[0] = vec4(1, 0, -s.x, -s.x * f - centre.x) / h.x;
        rows[1] = vec4(0, 1, -s.y, -s.y * f - centre.y) / h.y;
        rows[2] = vec4(0, 0, -1, -fit.near) / (fit.far - fit.near);
        rows[3] = vec4(0, 0, 0, 1);
    } else {
        // w = d; x w = ((s.x − c.x) d + (P.x − s.x) f) / h
        rows[0] = vec4(f, 0, -(s.x - centre.x), -s.x * f) / h.x;
        rows[1] = vec4(0, f, -(s.y - centre.y), -s.y * f) / h.y;
        rows[2] = vec4(0, 0, -fit.far, -fit.far * fit.near) / (fit.far - fit.near);
        rows[3] = vec4(0, 0, -1, 0);
    }
    LightViewBlock block;
    block.lightFromWorld = fromWorld;
    block.clipFromWorld = glm::transpose(rows) * fromWorld;
    block.sample_reference = {s, f, directional ? 1.0f : 0.0f};
    block.window = {centre, h};
    const vec2 given = radial ? description.range : vec2(0);
    const float near = given.x > 0 ? given.x : fit.near;
    float far = given.y > 0 ? given.y : radial ? fit.farthest : fit.far;
    if (given != vec2(0)) far = std::max(far, near * (1 + 1e-4f));
    block.range = {near, far, 1 / (far - near), radial ? 1.0f : 0.0f};
    block.light = {half, size, 1.0f / static_cast<float>(size)};
    return {block, fit.needless};
}

} // namespace

vec2 gridShift(uint32_t i) { return r2Point(i) - 0.5f; }

LightViewBlock lightView(const AreaLight& light, std::span<const Occluder> occluders,
                         const ShadowMapDescription& description, const View* view) {
    return fittedView(light, occluders, description, view).first;
}

namespace {

struct NeedlessConstants {
    LightViewBlock lightView;
    glm::uvec4 needless;
};

// Whether the point of the light lies outside the bounds of every closed surface, so that their backs are never
// nearest.
bool seesFromOutside(const Inputs& inputs, const LightViewBlock& view) {
    if (view.sample_reference.w != 0) return true;
    const vec3 point =
        vec3(glm::inverse(view.lightFromWorld) * vec4(view.sample_reference.x, view.sample_reference.y, 0, 1));
    return std::none_of(inputs.occluders.begin(), inputs.occluders.end(), [&](const Occluder& o) {
        const float slack = 1e-4f * o.boundsWorld.diagonal();
        return o.closed && glm::all(glm::greaterThanEqual(point, o.boundsWorld.min - slack)) &&
               glm::all(glm::lessThanEqual(point, o.boundsWorld.max + slack));
    });
}

} // namespace

ShadowMap drawShadowMap(Flow& flow, Scope scope, const Inputs& inputs, const ShadowMapDescription& description) {
    static constexpr Channel channels[] = {{"depth", "z",
                                            "linear depth from the light, (d − near) / (far − near); 1: nothing casts",
                                            Unit::DepthRange, 0, 1}};
    static constexpr Channel signed_[] = {{"depth", "z",
                                           "linear depth from the light, (d − near) / (far − near); 1: nothing casts; "
                                           "negative: what casts has moved since the last frame",
                                           Unit::DepthRange, -1, 1}};
    static constexpr std::string_view names[mostLayers] = {"shadow-map",   "shadow-map-2", "shadow-map-3",
                                                           "shadow-map-4", "shadow-map-5", "shadow-map-6",
                                                           "shadow-map-7", "shadow-map-8"};
    static constexpr std::string_view zNames[mostLayers] = {"shadow-map-z",   "shadow-map-z-2", "shadow-map-z-3",
                                                            "shadow-map-z-4", "shadow-map-z-5", "shadow-map-z-6",
                                                            "shadow-map-z-7", "shadow-map-z-8"};
    const int layer = description.layer;
    ensure(layer >= 0 && layer < mostLayers, "a shadow map layer that there is not");
    ensure(layer == 0 || description.samples == 1, "layers are peeled from maps of one sample");
    ensure(!description.signMovers || (layer == 0 && description.format == Format::R32F), "a depth that has no sign");
    const auto [view, needless] = fittedView(inputs.light, inputs.occluders, description, &inputs.view);
    const Extent extent{.width = description.size, .height = description.size, .samples = description.samples};
    const std::string_view name = description.samples > 1 ? "shadow-map-samples" : names[layer];
    const bool nearestOnly = layer == 0 && description.faces == Faces::Casting && seesFromOutside(inputs, view);
    Draw draw{.shader = "shadow_map.glsl",
              .geometry = inputs.geometry,
              .poseVersion = inputs.poseVersion,
              .faces = nearestOnly ? Faces::Nearest : description.faces,
              .castersOnly = true,
              .depthClamp = true,
              .border = description.border,
              .clear = {1, 1, 1, 1}};
    // The rasteriser's depth of an orthographic map is the stored depth already.
    if (view.sample_reference.w == 0) {
        static constexpr std::string_view metrics[] = {"LINEAR_DEPTH", "RADIAL", "RADIAL_OF_VERTICES"};
        draw.defines.push_back({metrics[static_cast<int>(description.metric)]});
    }
    if (description.signMovers) draw.defines.push_back({"SIGN_MOVERS"});
    PassSpec pass{.stage = Stage::ShadowMap, .name = name, .constants = view};
    if (description.averaged && needless != glm::uvec4(0)) {
        draw.defines.push_back({"NEEDLESS"});
        pass.constants = NeedlessConstants{view, needless};
    }
    if (description.format != Format::Depth32F) {
        draw.defines.push_back({"COLOUR_DEPTH"});
        pass.writes.push_back({name, description.format, extent, description.signMovers ? signed_ : channels});
        pass.writes.push_back({zNames[layer], Format::Depth32F, extent, channels});
    } else {
        pass.writes.push_back({name, Format::Depth32F, extent, channels});
    }
    if (description.objects) {
        ensure(layer == 0, "only the nearest surfaces are told apart");
        draw.defines.push_back({"OBJECTS", description.format != Format::Depth32F ? 1 : 0}); // its colour image
        pass.writes.push_back({"shadow-map-objects", Format::R32F, extent, objectChannels});
    }
    if (layer > 0) {
        ShadowMapDescription nearer = description;
        --nearer.layer;
        draw.defines.push_back({"PEELED"});
        pass.reads.push_back({"nearer", drawShadowMap(flow, scope, inputs, nearer).depth});
    }
    pass.work = draw;
    const Flow::Outputs images = flow.pass(scope, pass);
    ShadowMap map{images[0], view, {}};
    if (description.objects) map.objects = images[images.indices.size() - 1];
    return map;
}

ViewBlock viewBlock(const View& view) {
    return {view.clipFromWorld,  vec4(view.eyeWorld, 0), vec4(view.rayCorner, 0), vec4(view.rayDx, 0),
            vec4(view.rayDy, 0), vec4(view.eyeDx, 0),    vec4(view.eyeDy, 0),     vec4(view.size, view.near, view.far)};
}

ResolveConstants resolveConstants(const Inputs& inputs, const LightViewBlock& light, bool withMargin) {
    ResolveConstants constants{viewBlock(inputs.view), light};
    if (!withMargin) constants.view.rayDx.w = float(inputs.margin.x), constants.view.rayDy.w = float(inputs.margin.y);
    return constants;
}

Defines resolveDefines(const AreaLight& light) {
    return {{"DIRECTIONAL", light.shape == LightShape::Directional ? 1 : 0},
            {"ROUND", light.shape == LightShape::Rectangle ? 0 : 1}};
}

Flow::Outputs resolve(Flow& flow, Scope scope, const Inputs& inputs, const Resolver& resolver, const PassReads& reads,
                      const ParameterSet& parameters) {
    Compute work{resolver.shader, resolveDefines(inputs.light), resolver.over};
    for (const Define& define : resolver.defines) work.defines.push_back(define);
    if (resolver.table > 0) work.defines.push_back({"TABLE", resolver.table});
    const glm::ivec2 size = resolver.withMargin ? inputs.view.size : inputs.pictureSize();
    PassSpec pass{.stage = Stage::Resolve,
                  .name = resolver.pass,
                  .work = work,
                  .reads = {{"depth", inputs.geometryBuffer.depth}, {"normal", inputs.geometryBuffer.normal}},
                  .onto = resolver.onto,
                  .marks = resolver.marks,
                  .constants = resolver.constants,
                  .parameters = &parameters};
    for (const Read& read : reads) pass.reads.push_back(read);
    if (resolver.onto.empty())
        pass.writes.push_back(
            {resolver.writes, resolver.format, resolver.extent.value_or(Extent{size.x, size.y}), resolver.channels});
    for (const ImageSpec& image : resolver.also) pass.writes.push_back(image);
    return flow.pass(scope, pass);
}

} // namespace penumbra
