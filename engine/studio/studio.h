// SPDX-License-Identifier: Apache-2.0
// The interactive tool: takes input, draws its panels into an image, and says which work there is to do.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "studio/commands.h"
#include "studio/panels.h"
#include "studio/workspace.h"

struct ImGuiContext;
struct ImPlotContext;
struct GLFWwindow;

namespace photonloupe::studio {

struct StudioOptions {
    std::uint32_t width = 1600;
    std::uint32_t height = 900;
    float scale = 1.0f;       // of fonts and widgets
    bool is_offscreen = true; // no window; else a GLFW window
};

// How long frames took, milliseconds; the latest ones.
struct FrameStatistics {
    std::vector<double> frames;
    std::vector<double> loupe; // queries
    std::vector<double> plots; // parallel coordinates
};

// One thread uses it, except for what says otherwise.
class Studio {
public:
    // Throws DeviceError on a device that cannot draw, or where no window can be opened.
    Studio(Workbench& bench, const StudioOptions& options);
    ~Studio();
    Studio(const Studio&) = delete;
    Studio& operator=(const Studio&) = delete;

    // Takes input and what work has delivered, lays out and draws; in a window also shows it. Without a window there
    // are as many passes as the input needs, and views are finished.
    void frame();
    // Waits for input, at most so long; returns at once while something moves. False: nothing changed, a frame would
    // be the same.
    bool wait(double seconds);
    void hide();
    bool should_close() const;

    // RGBA8, row 0 at the top.
    std::vector<std::uint32_t> read_image();
    // A panel alone, by its name, at a size and scale of its own. Throws Error naming the panels there are.
    std::vector<std::uint32_t> read_panel(const std::string& name, std::uint32_t width, std::uint32_t height,
                                          float scale);
    void resize(std::uint32_t width, std::uint32_t height);
    std::uint32_t width() const { return m_canvas.width(); }
    std::uint32_t height() const { return m_canvas.height(); }

    // Input, as a window would send it; `chord` as "ctrl+enter". Throws Error for a key that is not known.
    void move_mouse(float x, float y);
    void press_mouse(int button, bool is_down);
    void turn_wheel(float steps);
    void press_key(const std::string& chord);
    void hold_key(const std::string& name, bool is_down);
    void type_text(const std::string& text);
    void drop_file(const std::string& path);

    // Throws Error naming the commands there are.
    void run_command(const std::string& name);
    std::optional<WidgetBox> find_widget(const std::string& name) const;
    std::vector<std::string> list_widgets() const;

    Workspace& workspace() { return m_workspace; }
    const Workspace& workspace() const { return m_workspace; }
    // A new state as a whole: sessions. Goes into the history.
    void set_state(const std::string& name, StudioState state);

    // The next piece of work, once; nothing while one is running.
    std::optional<Job> take_job();
    // For any thread: what happens before the next frame.
    void deliver(std::function<void(Workspace&)> change);
    // For any thread: progress of the work; false: it should stop.
    bool report_progress(const std::string& stage, double fraction);
    // The work has ended, well or not (empty: well).
    void end_job(const Job& job, const std::string& error);
    void stop_job();
    // For any thread: work of that kind is done again, also what is running now.
    void forget_work(const std::string& kind);

    FrameStatistics take_statistics();
    // Requests of files and sessions for whoever owns them.
    std::vector<std::string> take_requests();

private:
    void open_window(const StudioOptions& options);
    void begin_frame();
    void draw_frame();
    void take_deliveries();
    void lay_out();
    void lay_out_safely();
    bool has_input_left() const;

    Workspace m_workspace;
    ImGuiContext* m_context = nullptr;
    ImPlotContext* m_plots = nullptr;
    GLFWwindow* m_window = nullptr;
    std::unique_ptr<ImGuiVulkan> m_drawing;
    std::unique_ptr<gpu::WindowSurface> m_surface;
    gpu::Texture m_canvas;
    Panels m_panels;
    FrameStatistics m_statistics;
    std::mutex m_mutex; // of what other threads reach
    std::vector<std::function<void(Workspace&)>> m_deliveries;
    std::optional<Job> m_running;
    bool m_stop = false;
    bool m_is_stale = false; // what runs now is to be done again
    std::string m_progress_stage;
    double m_progress = 0;
    double m_chunk_milliseconds = 0; // of the device before the studio was opened
    std::uint32_t m_draws_left = 0;  // frames until nothing moves any more
};

} // namespace photonloupe::studio
