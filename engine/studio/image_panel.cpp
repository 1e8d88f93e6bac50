// SPDX-License-Identifier: Apache-2.0
// Lays out the image's panel; an open panel asks for the render.
#include "studio/image_panel.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/stage_choices.h"
#include "studio/tone_map.h"
#include "studio/widgets.h"

namespace photonloupe::studio {

void ImagePanel::draw_choices(Workspace& workspace) {
    ImageState image = workspace.state.image;
    const auto edit = [&](const std::string& name) {
        workspace.change(name, [&](StudioState& state) { state.image = image; });
    };
    const float half = 0.5f * ImGui::GetContentRegionAvail().x;
    ImGui::PushItemWidth(0.32f * ImGui::GetContentRegionAvail().x);
    if (ui::slide(workspace, "Image/Exposure", "exposure", image.exposure, -10, 10, "%.2f stops"))
        edit("exposure");
    ImGui::SameLine(half);
    if (ui::choose(workspace, "Image/Tone", "tone", image.tone, {"srgb", "filmic"}))
        edit("tone");
    if (ui::slide(workspace, "Image/Overlay", "false color", image.overlay, 0, 1, "%.2f"))
        edit("false color");
    ImGui::SameLine(half);
    if (ui::choose(workspace, "Image/Shows", "show", image.shows, {"image", "reference", "error"}))
        edit("shown image");
    ImGui::PopItemWidth();
    ImageState completed = complete_choices(image, workspace.state.trace);
    if (const std::string changed = ui::edit_settings(workspace, "Image", list_choices(image), list_choices(completed));
        !changed.empty())
        edit("image " + changed);
    if (ui::button(workspace, "Image/Compare", "Compare", "Load the reference named on the right (EXR, 640 × 480)"))
        workspace.change("reference", [&](StudioState& state) { state.image.reference = m_reference; });
    ImGui::SameLine();
    if (ui::button(workspace, "Image/Store", "Store", "Keep this picture as the reference (B of A/B)"))
        workspace.requests.push_back("store_reference");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##reference", "reference.exr", &m_reference);
    ui::mark(workspace, "Image/Reference");
}

void ImagePanel::draw_numbers(const Workspace& workspace) {
    if (!workspace.results.comparison || workspace.state.image.reference.empty())
        return;
    const ComparisonResult& comparison = *workspace.results.comparison;
    ImGui::Text("RMSE %.4g   relMSE %.4g   FLIP %s", comparison.rmse, comparison.relmse,
                std::isnan(comparison.flip) ? "–" : std::to_string(comparison.flip).substr(0, 6).c_str());
}

void ImagePanel::draw_image(Workspace& workspace) {
    const Results& results = workspace.results;
    const ImageState& choices = workspace.state.image;
    static const std::optional<Image> none;
    const bool has_reference = !choices.reference.empty();
    const std::optional<Image>& shown = choices.shows != "image" && !has_reference ? none
                                        : choices.shows == "reference"             ? results.reference
                                        : choices.shows == "error"                 ? results.error
                                                                                   : results.image;
    if (!shown) {
        ui::say_empty(choices.shows == "image"
                          ? (results.scene ? workspace.explain_wait("render", "the image is being rendered")
                                           : "rendering needs a scene; open one")
                          : "there is no reference; name one and press Compare, or Store this picture");
        return;
    }
    const std::string key = std::to_string(results.image_version) + choices.shows + choices.tone +
                            std::to_string(choices.exposure) + " " + std::to_string(choices.overlay);
    if (key != m_key) {
        m_key = key;
        m_width = shown->width;
        m_height = shown->height;
        ImageState plain = choices;
        if (choices.shows == "error") {
            plain.exposure = 0;
            plain.tone = "srgb";
        }
        const bool is_laid_over = choices.shows == "image" && results.colors && choices.overlay > 0 &&
                                  results.colors->rgb.size() == shown->rgb.size();
        workspace.pixels.set("image", m_width, m_height,
                             is_laid_over ? overlay_colors(*shown, *results.colors, plain) : map_tones(*shown, plain));
    }
    const ImVec2 free = ImGui::GetContentRegionAvail();
    const float scale = std::min(free.x / static_cast<float>(m_width), free.y / static_cast<float>(m_height));
    if (scale <= 0)
        return;
    ImGui::Image(static_cast<ImTextureID>(workspace.pixels.find("image")),
                 {scale * static_cast<float>(m_width), scale * static_cast<float>(m_height)});
    ui::mark(workspace, "Image/Picture");
}

void ImagePanel::draw(Workspace& workspace) {
    workspace.wants_render = true;
    draw_choices(workspace);
    draw_numbers(workspace);
    draw_image(workspace);
}

} // namespace photonloupe::studio
