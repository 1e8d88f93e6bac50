// SPDX-License-Identifier: Apache-2.0
// Lays out the script's panel and keeps the editor's text and the state's the same.
#include "studio/script_panel.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/edit_state.h"
#include "studio/script_language.h"
#include "studio/theme.h"
#include "studio/widgets.h"

namespace photonloupe::studio {
namespace {

constexpr float EDITOR_SHARE = 0.62f; // of the panel's height
constexpr std::size_t ERROR_MARK = 1;
constexpr ImU32 ERROR_COLOR = 0xff5070ff, ERROR_LINE_COLOR = 0x402030c0;

// The editor counts glyphs where the compiler counts bytes.
std::size_t count_glyphs(std::string_view line, std::uint32_t column) {
    std::size_t glyphs = 0;
    for (std::size_t i = 0; i + 1 < column && i < line.size(); ++i)
        glyphs += (static_cast<unsigned char>(line[i]) & 0xc0) != 0x80;
    return glyphs;
}

TextEditor::DocPos find_position(const script::Source& source, std::uint32_t offset) {
    const script::Place place = source.find_place(offset);
    return {place.line - 1, count_glyphs(source.line_text(place.line), place.column)};
}

double find_value(const StudioState& state, const script::Variable& variable) {
    const auto given = state.script.values.find(variable.name);
    if (given != state.script.values.end())
        return given->second;
    return variable.default_value.value_or(variable.exposed->low);
}

// True: the user moved it.
bool slide_variable(Workspace& workspace, const script::Variable& variable, double& value) {
    const script::Exposure& exposed = *variable.exposed;
    const std::string id = "##" + variable.name;
    bool changed = false;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize(variable.name.c_str()).x - ImGui::GetStyle().ItemInnerSpacing.x - 4);
    if (exposed.is_integer) {
        auto number = static_cast<std::int64_t>(std::llround(value));
        const auto low = static_cast<std::int64_t>(exposed.low), high = static_cast<std::int64_t>(exposed.high);
        changed = ImGui::SliderScalar(id.c_str(), ImGuiDataType_S64, &number, &low, &high);
        value = std::clamp(static_cast<double>(number), exposed.low, exposed.high);
    } else {
        changed = ImGui::SliderScalar(id.c_str(), ImGuiDataType_Double, &value, &exposed.low, &exposed.high, "%.4g",
                                      ImGuiSliderFlags_AlwaysClamp);
        if (exposed.step > 0)
            value = std::clamp(exposed.low + std::round((value - exposed.low) / exposed.step) * exposed.step,
                               exposed.low, exposed.high);
    }
    ui::mark(workspace, "Script/" + variable.name);
    ImGui::SameLine();
    ImGui::TextUnformatted(variable.name.c_str());
    return changed;
}

} // namespace

ScriptPanel::ScriptPanel(const Workspace& workspace) {
    m_editor.SetLanguage(find_script_language());
    m_editor.SetPalette(TextEditor::GetDarkPalette());
    m_editor.SetTabSize(2);
    m_editor.SetInsertSpacesOnTabs(true);
    m_editor.SetShowScrollbarMiniMapEnabled(false);
    m_editor.SetShowWhitespacesEnabled(false);
    m_editor.SetSmoothScrollingEnabled(false);
    m_editor.SetCompletePairedGlyphs(false);
    TextEditor::AutoCompleteConfig completion;
    completion.callback = [this](TextEditor::AutoCompleteState& state) { suggest_names(state, m_editor); };
    completion.triggerOnTyping = !workspace.is_offscreen; // it waits for a clock
    completion.triggerOnShortcut = !workspace.is_offscreen;
    m_editor.SetAutoCompleteConfig(&completion);
    m_editor.SetTextHoverCallback([this](TextEditor::PopupData& data) {
        const std::string word =
            m_editor.GetSectionText(m_editor.FindWordStart(data.pos, true), m_editor.FindWordEnd(data.pos, true));
        const std::string text = explain_word(word);
        if (text.empty()) {
            ImGui::CloseCurrentPopup();
            return;
        }
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
    });
    if (workspace.is_offscreen)
        m_editor.SetCustomCaretRenderer([](const TextEditor::CustomCaret& caret) {
            const ImVec2 low = caret.glyphPos;
            caret.drawList->AddRectFilled(low, {low.x + 1, low.y + caret.glyphSize.y}, caret.caretColor);
        });
}

void ScriptPanel::mark_diagnostics(const ScriptDocument& document) {
    if (m_marked_version == document.version() || !document.compiled())
        return;
    m_marked_version = document.version();
    m_editor.ClearMarkers();
    m_editor.ClearSquiggles();
    const script::Source& source = document.compiled()->program.source;
    for (const script::Diagnostic& diagnostic : document.compiled()->diagnostics) {
        const bool is_error = diagnostic.severity == script::Severity::error;
        const std::string text =
            diagnostic.code + ": " + diagnostic.message + (diagnostic.note.empty() ? "" : "\n" + diagnostic.note);
        const TextEditor::DocPos begin = find_position(source, diagnostic.span.begin);
        const TextEditor::DocPos end = find_position(source, std::max(diagnostic.span.end, diagnostic.span.begin + 1));
        m_editor.AddSquiggle(begin, end, ERROR_MARK, is_error ? ERROR_COLOR : WARNING_COLOR, text);
        if (is_error)
            m_editor.AddMarker(begin.line, ERROR_COLOR, ERROR_LINE_COLOR, text, text);
    }
}

void ScriptPanel::draw_toolbar(Workspace& workspace) {
    if (ui::button(workspace, "Script/Run", "Run", "Run the script over the photons (Ctrl-Enter)"))
        run_script(workspace);
    ImGui::SameLine();
    if (ui::button(workspace, "Script/Examples", "Examples"))
        ImGui::OpenPopup("examples");
    if (ImGui::BeginPopup("examples")) {
        for (const ExampleScript& example : workspace.examples) {
            const std::string name = std::filesystem::path(example.path).stem().string();
            if (ImGui::Selectable(name.c_str()))
                open_script(workspace, example.path, example.text);
            ui::mark(workspace, "Script/Examples/" + name);
        }
        if (workspace.examples.empty())
            ImGui::TextDisabled("none were found");
        ImGui::EndPopup();
    }
    ImGui::SameLine();
    if (ui::button(workspace, "Script/Load", "Load", "Load the file named on the right"))
        workspace.requests.push_back("open " + m_path);
    ImGui::SameLine();
    if (ui::button(workspace, "Script/Save", "Save", "Save the text under the name on the right"))
        workspace.requests.push_back("save_script " + m_path);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##path", "file.photon", &m_path);
    ui::mark(workspace, "Script/Path");
}

void ScriptPanel::draw_editor(Workspace& workspace) {
    std::string& text = workspace.state.script.text;
    if (text != m_text) {
        m_editor.SetText(text);
        m_text = text;
        m_shown = m_editor.GetText(); // it ends lines its own way
        m_path = workspace.state.script.path;
    }
    workspace.script.check(text, workspace.state.script.path.empty() ? "script" : workspace.state.script.path);
    mark_diagnostics(workspace.script);
    // Ctrl-Enter runs; the editor would break the line.
    m_editor.SetReadOnlyEnabled(ImGui::IsKeyChordPressed(ImGuiMod_Ctrl | ImGuiKey_Enter));
    ImGui::PushFont(workspace.fonts.code, 0.0f);
    m_editor.Render("##editor", {0, ImGui::GetContentRegionAvail().y * EDITOR_SHARE}, ImGuiChildFlags_Borders);
    ImGui::PopFont();
    ui::mark(workspace, "Script/Editor");
    std::string edited = m_editor.GetText();
    if (edited == m_shown)
        return;
    workspace.change("edit script", [&](StudioState& state) { state.script.text = edited; });
    m_text = edited;
    m_shown = std::move(edited);
}

void ScriptPanel::draw_sliders(Workspace& workspace) {
    const script::CompiledScript* compiled = workspace.script.compiled();
    if (!compiled || workspace.script.has_errors())
        return;
    for (const std::uint32_t index : compiled->program.exposed) {
        const script::Variable& variable = compiled->program.variables[index];
        double value = find_value(workspace.state, variable);
        if (!slide_variable(workspace, variable, value))
            continue;
        workspace.change("set " + variable.name, [&](StudioState& state) {
            state.script.values[variable.name] = value;
            // The slider belongs to the text in the editor; moving it runs that text.
            state.script.ran = state.script.text;
        });
    }
}

void ScriptPanel::draw_report(Workspace& workspace) {
    const std::size_t errors = workspace.script.count_errors();
    if (errors > 0) {
        const script::CompiledScript& compiled = *workspace.script.compiled();
        ImGui::PushStyleColor(ImGuiCol_Text, WARNING_COLOR);
        ImGui::TextWrapped("%zu error%s; the last good run stays", errors, errors == 1 ? "" : "s");
        ImGui::PopStyleColor();
        ui::mark(workspace, "Script/Errors");
        for (const script::Diagnostic& diagnostic : compiled.diagnostics)
            ImGui::TextWrapped("line %u: %s %s", compiled.program.source.find_place(diagnostic.span.begin).line,
                               diagnostic.message.c_str(), diagnostic.note.c_str());
    } else if (workspace.state.script.text != workspace.state.script.ran) {
        ImGui::TextDisabled("not run yet: Ctrl-Enter");
    }
    if (!workspace.results.script)
        return;
    const ScriptResult& result = *workspace.results.script;
    if (!workspace.is_offscreen)
        ImGui::TextDisabled("last run: %.0f ms", result.milliseconds);
    for (const std::string& line : result.report)
        ImGui::TextWrapped("%s", line.c_str());
    for (const std::string& line : result.prints)
        ImGui::TextWrapped("%s", line.c_str());
}

void ScriptPanel::draw(Workspace& workspace) {
    draw_toolbar(workspace);
    draw_editor(workspace);
    ImGui::BeginChild("##below");
    draw_sliders(workspace);
    draw_report(workspace);
    ImGui::EndChild();
}

} // namespace photonloupe::studio
