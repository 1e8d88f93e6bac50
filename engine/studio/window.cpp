// SPDX-License-Identifier: Apache-2.0
// GLFW, and ImGui's backend for it.
#include "studio/window.h"

#include <algorithm>
#include <chrono>

#include <imgui.h>
#include <imgui_impl_glfw.h>

#include <GLFW/glfw3.h>

#include "core/error.h"
#include "studio/studio.h"

namespace photonloupe::studio {
namespace {

constexpr float LARGEST_SCALE = 4.0f;

void drop_files(GLFWwindow* window, int count, const char** paths) {
    auto* studio = static_cast<Studio*>(glfwGetWindowUserPointer(window));
    for (int i = 0; i < count; ++i)
        studio->drop_file(paths[i]);
}

} // namespace

GLFWwindow* open_window(std::uint32_t width, std::uint32_t height, Studio& studio) {
    const char* reason = nullptr;
    if (!glfwInit() || !glfwVulkanSupported()) {
        glfwGetError(&reason);
        throw DeviceError(std::string("no window can be opened (") + (reason ? reason : "no Vulkan for windows") +
                          "); on a machine without a screen use `studio --screenshot`");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    GLFWwindow* window =
        glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), "Photon Loupe", nullptr, nullptr);
    if (!window) {
        glfwGetError(&reason);
        glfwTerminate();
        throw DeviceError(std::string("no window can be opened (") + (reason ? reason : "unknown") +
                          "); on a machine without a screen use `studio --screenshot`");
    }
    glfwSetWindowUserPointer(window, &studio);
    glfwSetDropCallback(window, drop_files);
    ImGui_ImplGlfw_InitForVulkan(window, true);
    return window;
}

void close_window(GLFWwindow* window) {
    ImGui_ImplGlfw_Shutdown();
    glfwDestroyWindow(window);
    glfwTerminate();
}

void hide_window(GLFWwindow& window) {
    glfwHideWindow(&window);
    glfwPollEvents();
}

void begin_window_frame() {
    ImGui_ImplGlfw_NewFrame();
}

bool wait_for_input(double seconds) {
    const auto start = std::chrono::steady_clock::now();
    if (seconds <= 0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(seconds);
    return seconds > 0 &&
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 0.95 * seconds;
}

bool is_closing(GLFWwindow& window) {
    return glfwWindowShouldClose(&window);
}

void find_window_size(GLFWwindow& window, std::uint32_t& width, std::uint32_t& height) {
    int pixels_across = 0, pixels_down = 0;
    glfwGetFramebufferSize(&window, &pixels_across, &pixels_down);
    width = static_cast<std::uint32_t>(std::max(pixels_across, 0));
    height = static_cast<std::uint32_t>(std::max(pixels_down, 0));
}

float find_monitor_scale(GLFWwindow& window) {
    float x = 1, y = 1;
    glfwGetWindowContentScale(&window, &x, &y);
    return std::clamp(std::max(x, y), 1.0f, LARGEST_SCALE);
}

} // namespace photonloupe::studio
