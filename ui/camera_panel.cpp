// SPDX-License-Identifier: MIT
#include "ui/camera_panel.h"

#include "ui/numbers.h"

namespace penumbra {

namespace {

std::string nameOf(const Scene& scene, size_t index) {
    const std::string& name = scene.cameras[index].name;
    return name.empty() ? fmt::format("camera {}", index + 1) : name;
}

} // namespace

void CameraPanel::choose(Session& session, const SceneFacts& facts, size_t index) {
    chosen_ = index;
    taken_ = session.camera = sceneCamera(*facts.scene, facts.pose, facts.scene->cameras[index]);
}

std::string CameraPanel::next(Session& session, const SceneFacts& facts) {
    const size_t count = facts.scene->cameras.size();
    if (count == 0) return "The scene has no cameras of its own";
    choose(session, facts, session.camera == taken_ ? (chosen_ + 1) % count : 0);
    return fmt::format("Camera {} of {}: {}", chosen_ + 1, count, nameOf(*facts.scene, chosen_));
}

void CameraPanel::draw(Session& session, const SceneFacts& facts, ViewSettings& settings) {
    Camera& camera = session.camera;
    const Scene& scene = *facts.scene;
    if (!scene.cameras.empty()) {
        row("Of the scene");
        const bool stands = camera == taken_ && chosen_ < scene.cameras.size();
        if (beginCombo("##cameras", stands ? nameOf(scene, chosen_).c_str() : "choose…")) {
            for (size_t i = 0; i < scene.cameras.size(); ++i) {
                ImGui::PushID(static_cast<int>(i));
                if (ImGui::Selectable(nameOf(scene, i).c_str(), stands && i == chosen_)) choose(session, facts, i);
                ImGui::PopID();
            }
            ImGui::EndCombo();
        }
        tooltip("The cameras that the scene holds (C: the next one)");
    }
    pointRows("Eye  [m]", "Where the camera stands", camera.eye,
              "What the camera looks at and orbits round (double click in the view)", camera.target, facts.size);
    row("Field of view");
    dragNumber("##fov", camera.fovY, 0.2f, limits::fovY, "%.1f°");
    tooltip("From the lower to the upper edge of the view");
    row("Flying speed");
    float metres = settings.flySpeed * facts.size;
    if (dragDecades("##speed", metres, {0.001 * facts.size, 10.0 * facts.size}, "%.3g m/s"))
        settings.flySpeed = metres / facts.size;
    tooltip("Of W A S D E Q in the view; Shift: four times as fast (+ and −, or the wheel during a right drag)");
    if (ImGui::Button("Reset camera")) camera = defaultCamera(scene, facts.pose);
    tooltip("Back to the scene's own camera (Home in the view)");
}

} // namespace penumbra
