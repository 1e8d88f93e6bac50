// SPDX-License-Identifier: Apache-2.0
// Frames: input, deliveries, layout, drawing; and the hand-over of work between threads.
#include "studio/studio.h"

#include <algorithm>
#include <chrono>

#include <imgui.h>
#include <imgui_internal.h>
#include <implot.h>

#include "core/error.h"
#include "gpu/window_surface.h"
#include "studio/theme.h"
#include "studio/window.h"

namespace photonloupe::studio {
namespace {

constexpr float OFFSCREEN_STEP = 1.0f / 60.0f; // seconds a frame takes without a window
constexpr int MOST_PASSES = 256;               // of one frame without a window
constexpr std::uint32_t QUIET_FRAMES = 3;      // until hover and layout have settled after input
constexpr std::size_t MOST_STATISTICS = 10'000;
// While a window is open dispatches stay under 15 ms: chunks aim lower, for they vary.
constexpr double WATCHED_CHUNK_MILLISECONDS = 8.0;
constexpr std::uint32_t SMALLEST_SIDE = 64, LARGEST_SIDE = 8192;

double measure_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void check_size(std::uint32_t width, std::uint32_t height) {
    if (width < SMALLEST_SIDE || height < SMALLEST_SIDE || width > LARGEST_SIDE || height > LARGEST_SIDE)
        throw Error("the studio's size is " + std::to_string(width) + " × " + std::to_string(height) +
                    "; each side is " + std::to_string(SMALLEST_SIDE) + " to " + std::to_string(LARGEST_SIDE) +
                    " pixels");
}

const StudioOptions& check_options(const StudioOptions& options) {
    check_size(options.width, options.height);
    return options;
}

// The two libraries' current contexts are the thread's: a Studio makes its own current for as long as it works.
class Current {
public:
    Current(ImGuiContext* context, ImPlotContext* plots)
        : m_context(ImGui::GetCurrentContext()), m_plots(ImPlot::GetCurrentContext()) {
        ImGui::SetCurrentContext(context);
        ImPlot::SetCurrentContext(plots);
    }
    ~Current() {
        ImGui::SetCurrentContext(m_context);
        ImPlot::SetCurrentContext(m_plots);
    }

private:
    ImGuiContext* m_context;
    ImPlotContext* m_plots;
};

} // namespace

Studio::Studio(Workbench& bench, const StudioOptions& options)
    : m_workspace(bench), m_canvas(bench.device(), check_options(options).width, options.height) {
    gpu::Device& device = bench.device();
    IMGUI_CHECKVERSION();
    // Whoever makes the first context makes it current: it must not stay so once it is gone.
    const Current none(ImGui::GetCurrentContext(), ImPlot::GetCurrentContext());
    m_context = ImGui::CreateContext();
    m_plots = ImPlot::CreateContext();
    const Current current(m_context, m_plots);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_DockingEnable;
    io.ConfigInputTrickleEventQueue = true;
    io.ConfigErrorRecoveryEnableAssert = false;
    io.ConfigErrorRecoveryEnableTooltip = false;
    io.ConfigErrorRecoveryEnableDebugLog = true; // one of them must be
    io.ConfigInputTextCursorBlink = !options.is_offscreen;
    m_workspace.is_offscreen = options.is_offscreen;
    m_workspace.scale = options.scale;
    if (!options.is_offscreen)
        open_window(options);
    apply_theme(m_workspace.scale);
    m_workspace.fonts = load_fonts(m_workspace.scale);
    m_drawing = std::make_unique<ImGuiVulkan>(device);
    m_workspace.pixels.attach(*m_drawing);
    io.DisplaySize = {static_cast<float>(options.width), static_cast<float>(options.height)};
    m_chunk_milliseconds = device.chunk_milliseconds();
    if (!options.is_offscreen)
        device.set_chunk_milliseconds(WATCHED_CHUNK_MILLISECONDS);
}

Studio::~Studio() {
    const Current current(m_context, m_plots);
    m_workspace.device.set_chunk_milliseconds(m_chunk_milliseconds);
    m_workspace.pixels.clear();
    m_drawing.reset();
    m_surface.reset();
    if (m_window)
        close_window(m_window);
    ImPlot::DestroyContext(m_plots);
    ImGui::DestroyContext(m_context);
}

void Studio::open_window(const StudioOptions& options) {
    m_window = studio::open_window(options.width, options.height, *this);
    m_workspace.scale = options.scale * find_monitor_scale(*m_window);
    m_surface = open_surface(m_workspace.device, *m_window);
}

void Studio::take_deliveries() {
    std::vector<std::function<void(Workspace&)>> deliveries;
    {
        std::lock_guard lock(m_mutex);
        deliveries.swap(m_deliveries);
        m_workspace.activity = {m_running.has_value(), m_stop, m_progress_stage, m_progress};
    }
    for (const auto& change : deliveries)
        change(m_workspace);
}

bool Studio::has_input_left() const {
    return m_context->InputEventsQueue.Size > 0;
}

void Studio::begin_frame() {
    ImGuiIO& io = ImGui::GetIO();
    if (m_window) {
        begin_window_frame();
        std::uint32_t width = 0, height = 0;
        find_window_size(*m_window, width, height);
        if (width >= SMALLEST_SIDE && height >= SMALLEST_SIDE &&
            (width != m_canvas.width() || height != m_canvas.height()))
            m_canvas = gpu::Texture(m_workspace.device, width, height);
    } else {
        io.DeltaTime = OFFSCREEN_STEP;
    }
    io.DisplaySize = {static_cast<float>(m_canvas.width()), static_cast<float>(m_canvas.height())};
    io.DisplayFramebufferScale = {1, 1};
    m_drawing->begin_frame();
    ImGui::NewFrame();
    m_workspace.drop_unwanted();
    m_workspace.widgets.clear();
    m_workspace.is_settled = true;
    ++m_workspace.frame;
}

void Studio::lay_out() {
    if (!m_workspace.solo.empty()) {
        m_panels.draw(m_workspace);
        return;
    }
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImGuiID dock = ImGui::GetID("photonloupe");
    const float status_height = ImGui::GetFrameHeight() + 4 * m_workspace.scale;
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize({viewport->Size.x, viewport->Size.y - status_height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##host", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar(2);
    if (!ImGui::DockBuilderGetNode(dock))
        Panels::arrange(dock, viewport->Size.x, viewport->Size.y - status_height);
    ImGui::DockSpace(dock);
    ImGui::End();
    run_pressed_commands(m_workspace);
    m_panels.draw(m_workspace);
    if (!ImGui::IsAnyItemActive() && !ImGui::IsMouseDown(0) && !ImGui::GetIO().WantTextInput)
        m_workspace.history.end_gesture();
}

// What goes wrong in a panel is said, and the rest of the frame stands.
void Studio::lay_out_safely() {
    ImGuiErrorRecoveryState before;
    ImGui::ErrorRecoveryStoreState(&before);
    try {
        lay_out();
    } catch (const DeviceError&) {
        ImGui::ErrorRecoveryTryToRecoverState(&before);
        ImGui::EndFrame();
        throw;
    } catch (const std::exception& error) {
        ImGui::ErrorRecoveryTryToRecoverState(&before);
        m_workspace.say(error.what(), true);
    }
}

void Studio::frame() {
    const Current current(m_context, m_plots);
    take_deliveries();
    const auto start = std::chrono::steady_clock::now();
    std::uint32_t quiet = 0;
    for (int pass = 0; pass < MOST_PASSES && quiet < QUIET_FRAMES; ++pass) {
        const bool had_input = has_input_left();
        begin_frame();
        lay_out_safely();
        ImGui::Render();
        quiet = had_input || !m_workspace.is_settled ? 0 : quiet + 1;
        if (m_window)
            break;
    }
    draw_frame();
    m_workspace.frame_milliseconds = measure_since(start);
    const auto keep = [](std::vector<double>& list, double value) {
        if (list.size() < MOST_STATISTICS)
            list.push_back(value);
    };
    keep(m_statistics.frames, m_workspace.frame_milliseconds);
    for (const double value : std::exchange(m_workspace.loupe_times, {}))
        keep(m_statistics.loupe, value);
    for (const double value : std::exchange(m_workspace.plot_times, {}))
        keep(m_statistics.plots, value);
}

void Studio::draw_frame() {
    {
        gpu::Commands commands(m_workspace.device, "interface");
        m_workspace.pixels.upload(commands);
        m_drawing->draw(commands, m_canvas, *ImGui::GetDrawData());
        commands.run();
    }
    if (m_surface)
        m_surface->present(m_canvas);
}

bool Studio::wait(double seconds) {
    const Current current(m_context, m_plots);
    if (!m_workspace.is_settled || ImGui::IsAnyItemActive() || has_input_left())
        m_draws_left = QUIET_FRAMES;
    {
        std::lock_guard lock(m_mutex);
        if (!m_deliveries.empty())
            m_draws_left = std::max(m_draws_left, 1u);
    }
    if (m_window && wait_for_input(m_draws_left > 0 ? 0 : seconds))
        m_draws_left = QUIET_FRAMES;
    std::lock_guard lock(m_mutex);
    if (!m_deliveries.empty() || m_running)
        m_draws_left = std::max(m_draws_left, 1u);
    if (m_draws_left == 0)
        return false;
    --m_draws_left;
    return true;
}

void Studio::hide() {
    if (m_window)
        hide_window(*m_window);
}

bool Studio::should_close() const {
    return m_window && is_closing(*m_window);
}

std::vector<std::uint32_t> Studio::read_image() {
    gpu::Buffer pixels(m_workspace.device, std::uint64_t{m_canvas.width()} * m_canvas.height() * 4, "screenshot");
    gpu::Commands commands(m_workspace.device, "screenshot");
    commands.copy(m_canvas, pixels);
    commands.run();
    return pixels.read<std::uint32_t>(std::uint64_t{m_canvas.width()} * m_canvas.height());
}

std::vector<std::uint32_t> Studio::read_panel(const std::string& name, std::uint32_t width, std::uint32_t height,
                                              float scale) {
    require_panel(name);
    Studio alone(m_workspace.bench, {width, height, scale, true});
    Workspace& copy = alone.m_workspace;
    copy.solo = name;
    copy.state = m_workspace.state;
    copy.results = m_workspace.results;
    copy.done = m_workspace.done;
    copy.loupe = m_workspace.loupe;
    copy.loupe_normal = m_workspace.loupe_normal;
    copy.pinned = m_workspace.pinned;
    alone.frame();
    return alone.read_image();
}

void Studio::resize(std::uint32_t width, std::uint32_t height) {
    check_size(width, height);
    const Current current(m_context, m_plots);
    m_canvas = gpu::Texture(m_workspace.device, width, height);
}

void Studio::run_command(const std::string& name) {
    const Current current(m_context, m_plots);
    find_command(name).run(m_workspace);
    m_workspace.history.end_gesture();
}

void Studio::set_state(const std::string& name, StudioState state) {
    m_workspace.history.record(name, m_workspace.state);
    m_workspace.history.end_gesture();
    const bool is_same_map = m_workspace.state.trace == state.trace;
    m_workspace.state = std::move(state);
    if (is_same_map) // else when its photons come
        m_workspace.drop_unknown_ids();
    ++m_workspace.selection_version;
    ++m_workspace.loupe_version;
}

FrameStatistics Studio::take_statistics() {
    return std::exchange(m_statistics, {});
}

std::vector<std::string> Studio::take_requests() {
    return std::exchange(m_workspace.requests, {});
}

std::optional<WidgetBox> Studio::find_widget(const std::string& name) const {
    const auto found = m_workspace.widgets.find(name);
    return found == m_workspace.widgets.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> Studio::list_widgets() const {
    std::vector<std::string> names;
    for (const auto& [name, box] : m_workspace.widgets)
        names.push_back(name);
    return names;
}

} // namespace photonloupe::studio
