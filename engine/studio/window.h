// SPDX-License-Identifier: Apache-2.0
// The GLFW window: opens, closes, and passes on input and dropped files.
#pragma once

#include <cstdint>
#include <string>

struct GLFWwindow;

namespace photonloupe::studio {

class Studio;

// Throws DeviceError where there is no screen. `studio` gets the files that are dropped on it.
GLFWwindow* open_window(std::uint32_t width, std::uint32_t height, Studio& studio);
void close_window(GLFWwindow* window);
void hide_window(GLFWwindow& window);
void begin_window_frame();
// True: there was input.
bool wait_for_input(double seconds);
bool is_closing(GLFWwindow& window);
void find_window_size(GLFWwindow& window, std::uint32_t& width, std::uint32_t& height);
float find_monitor_scale(GLFWwindow& window);

} // namespace photonloupe::studio
