// SPDX-License-Identifier: MIT
#include "ui/light_panel.h"

#include "ui/numbers.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace penumbra {

namespace {

std::string nameOf(const Scene& scene, size_t index) {
    const std::string& name = scene.lights[index].name;
    return name.empty() ? fmt::format("light {}", index + 1) : name;
}

} // namespace

void LightPanel::choose(Session& session, const SceneFacts& facts, size_t index) {
    chosen_ = index;
    taken_ = session.light = sceneLight(*facts.scene, facts.pose, facts.scene->lights[index]);
}

std::string LightPanel::next(Session& session, const SceneFacts& facts) {
    const size_t count = facts.scene->lights.size();
    if (count == 0) return "The scene has no lights of its own";
    choose(session, facts, session.light == taken_ ? (chosen_ + 1) % count : 0);
    return fmt::format("Light {} of {}: {}", chosen_ + 1, count, nameOf(*facts.scene, chosen_));
}

void LightPanel::draw(Session& session, const SceneFacts& facts, ViewSettings& settings) {
    AreaLight& light = session.light;
    ofScene(session, facts);
    shapeAndSize(light);
    pointRows("Position  [m]", "The centre of the light", light.position, "The point that the light faces",
              light.target, facts.size);
    direction(light, facts.size);
    row("Intensity");
    dragNumber("##intensity", light.intensity, 0.01f, {0, 1000}, "%.3f");
    tooltip("Irradiance at the target when it faces the light, relative to white");
    row("Colour");
    ImGui::ColorEdit3("##colour", &light.colour.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs);
    tooltip("Linear, before the intensity");
    row("Handles");
    ImGui::Checkbox("##handles", &settings.lightShown);
    tooltip("Draws the light in the view: drag its centre, its target or its edge (G; also while L is held)");
    if (ImGui::Button("Reset light")) light = defaultLight(*facts.scene, facts.pose);
    tooltip("Back to the scene's own light (L + Home in the view)");
    furtherLights(session, facts);
}

// Numbered as their buffers are: light-2 is the first of them.
void LightPanel::furtherLights(Session& session, const SceneFacts& facts) {
    std::vector<FurtherLight>& lights = session.furtherLights;
    if (!lights.empty()) subtitle("Further lights");
    std::optional<size_t> removed;
    for (size_t i = 0; i < lights.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        auto& [light, on] = lights[i];
        row(ShortText("light-{}", i + 2).begin());
        ImGui::Checkbox("##on", &on);
        tooltip("Whether it shines. Every light that shines has shadows, buffers and costs of its own.");
        ImGui::SameLine();
        if (ImGui::Button("Study")) std::swap(session.light, light);
        tooltip("Makes it the light that the panel turns and that ψ, the truth and errors are of; the other takes its "
                "place here.");
        ImGui::SameLine();
        if (ImGui::Button("Remove")) removed = i;
        ImGui::PopID();
    }
    if (removed) lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(*removed));
    ImGui::BeginDisabled(lights.size() == mostFurtherLights);
    if (ImGui::Button("Add a light")) lights.push_back({another(session, facts)});
    ImGui::EndDisabled();
    tooltip(
        ShortText("The next of the scene's lights that does not shine yet, or one like this, half as bright, turned "
                  "round its target; up to {} beside the first",
                  mostFurtherLights)
            .begin());
}

AreaLight LightPanel::another(const Session& session, const SceneFacts& facts) {
    const auto shines = [&](const AreaLight& light) {
        return light == session.light ||
               std::any_of(session.furtherLights.begin(), session.furtherLights.end(),
                           [&](const FurtherLight& further) { return further.light == light; });
    };
    for (const NamedLight& named : facts.scene->lights)
        if (const AreaLight light = sceneLight(*facts.scene, facts.pose, named); !shines(light)) return light;
    AreaLight light = session.light;
    light.intensity *= furtherLightShare;
    LightDirection direction = lightDirection(light);
    direction.elevation = std::clamp(direction.elevation, -60.0f, 60.0f); // one overhead has nowhere to turn
    for (size_t i = 0; i == 0 || (i <= mostFurtherLights && shines(light)); ++i) {
        direction.azimuth = std::remainder(direction.azimuth + 100, 360.0f);
        setLightDirection(light, direction);
    }
    return light;
}

void LightPanel::ofScene(Session& session, const SceneFacts& facts) {
    const Scene& scene = *facts.scene;
    if (scene.lights.empty()) return;
    row("Of the scene");
    const bool stands = session.light == taken_ && chosen_ < scene.lights.size();
    if (beginCombo("##lights", stands ? nameOf(scene, chosen_).c_str() : "choose…")) {
        for (size_t i = 0; i < scene.lights.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(nameOf(scene, i).c_str(), stands && i == chosen_)) choose(session, facts, i);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    tooltip("The lights that the scene holds (L + C: the next one)");
}

void LightPanel::shapeAndSize(AreaLight& light) {
    row("Shape");
    const auto shapes = lightShapeNames();
    if (beginCombo("##shape", ShortText("{}", shapes[static_cast<size_t>(light.shape)]).begin())) {
        for (size_t i = 0; i < shapes.size(); ++i)
            if (ImGui::Selectable(ShortText("{}", shapes[i]).begin(), static_cast<size_t>(light.shape) == i))
                changeShape(light, static_cast<LightShape>(i));
        ImGui::EndCombo();
    }
    tooltip("A rectangle or a disk near the scene, or a directional light so far away that all its rays come from the "
            "same small disk of the sky. Its size stays as the target sees it.");
    if (light.shape == LightShape::Directional) {
        row("Angular diameter");
        dragDecades("##angle", light.size.x, limits::lightDegrees, "%.3g°");
        tooltip("Full angle under which the light is seen (comma and period in the view). The sun and the moon: 0.53°; "
                "the sun "
                "through thin cloud: about 5°; a bright patch of an overcast sky: 30° and more.");
        return;
    }
    constexpr const char* help = "Full size (comma and period in the view). A bulb: 0.06 m; a ceiling panel: 0.6 m; "
                                 "a softbox: 0.6 to 1.2 m; a window: 1 to 2 m.";
    row(light.shape == LightShape::Disk ? "Diameter" : "Width");
    dragDecades("##width", light.size.x, limits::lightMetres, "%.4g m");
    tooltip(help);
    if (light.shape == LightShape::Disk) return;
    row("Height");
    dragDecades("##height", light.size.y, limits::lightMetres, "%.4g m");
    tooltip(help);
}

void LightPanel::direction(AreaLight& light, float sceneSize) {
    LightDirection direction = lightDirection(light);
    row("Azimuth");
    bool turned = dragNumber("##azimuth", direction.azimuth, 0.5f, {-180, 180}, "%.1f°");
    tooltip("Round the target, from +Z towards +X (L + drag in the view)");
    row("Elevation");
    turned |= dragNumber("##elevation", direction.elevation, 0.5f, {-90, 90}, "%.1f°");
    tooltip("Above the target's horizon (L + drag in the view)");
    row("Distance");
    turned |= dragNumber("##distance", direction.distance, 0.003f * sceneSize,
                         {1e-4 * static_cast<double>(sceneSize), limits::coordinate.max},
                         ShortText("{} m", metreFormat(sceneSize).view()).begin());
    tooltip("From the target (L + wheel in the view)");
    if (turned) setLightDirection(light, direction);
}

} // namespace penumbra
