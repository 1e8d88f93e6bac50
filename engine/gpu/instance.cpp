// SPDX-License-Identifier: Apache-2.0
// Opens the Vulkan loader, makes the instance and listens to the validation layers.
#include "gpu/instance.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/cache_folder.h"
#include "core/error.h"

namespace photonloupe::gpu {
namespace {

constexpr const char* VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

// Every message counts: none is let through.
VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto* log = static_cast<ValidationLog*>(user);
    std::lock_guard lock(log->mutex);
    log->messages.emplace_back(data->pMessage ? data->pMessage : "(no text)");
    return VK_FALSE;
}

// Mesa reads its own disk cache's place from the environment; ours keeps driver code between runs.
void point_driver_cache_at_our_folder() {
    const std::filesystem::path folder = find_cache_folder();
    if (!folder.empty())
        setenv("MESA_SHADER_CACHE_DIR", (folder / "mesa").c_str(), 0);
}

std::string read_validation_mode() {
    const char* value = std::getenv("PHOTONLOUPE_VALIDATION");
    if (!value || !*value || std::strcmp(value, "0") == 0)
        return {};
    if (std::strcmp(value, "core") == 0 || std::strcmp(value, "1") == 0)
        return "core";
    if (std::strcmp(value, "sync") == 0)
        return "sync";
    throw DeviceError("PHOTONLOUPE_VALIDATION is '" + std::string(value) + "'; use core, sync or 0");
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

// What a window needs (GLFW 3.3 opens X11's); absent ones are left out, and opening a window then says so.
std::vector<const char*> find_surface_extensions() {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "vkEnumerateInstanceExtensionProperties");
    std::vector<VkExtensionProperties> there(count);
    check(vkEnumerateInstanceExtensionProperties(nullptr, &count, there.data()),
          "vkEnumerateInstanceExtensionProperties");
    std::vector<const char*> names;
    for (const char* name : {"VK_KHR_surface", "VK_KHR_xcb_surface", "VK_KHR_xlib_surface"})
        if (std::any_of(there.begin(), there.end(), [&](const VkExtensionProperties& extension) {
                return std::strcmp(extension.extensionName, name) == 0;
            }))
            names.push_back(name);
    return names;
}

VkDebugUtilsMessengerCreateInfoEXT describe_messenger(ValidationLog& log) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    info.pfnUserCallback = collect_message;
    info.pUserData = &log;
    return info;
}

} // namespace

std::shared_ptr<Instance> Instance::acquire() {
    static std::mutex mutex;
    static std::weak_ptr<Instance> shared;
    std::lock_guard lock(mutex);
    if (auto instance = shared.lock())
        return instance;
    std::shared_ptr<Instance> instance(new Instance());
    shared = instance;
    return instance;
}

Instance::Instance() : m_validation_mode(read_validation_mode()) {
    point_driver_cache_at_our_folder();
    if (volkInitialize() != VK_SUCCESS)
        throw DeviceError("no Vulkan loader on this machine (libvulkan.so.1); install libvulkan1 and a driver, "
                          "for example mesa-vulkan-drivers for the software device");
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "photonloupe";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    VkDebugUtilsMessengerCreateInfoEXT messenger = describe_messenger(m_log);
    const VkValidationFeatureEnableEXT sync = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &sync;
    std::vector<const char*> extensions = find_surface_extensions();
    if (!m_validation_mode.empty()) {
        if (!has_layer(VALIDATION_LAYER))
            throw DeviceError("validation was asked for but the layer is not installed; install "
                              "vulkan-validationlayers or unset PHOTONLOUPE_VALIDATION");
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &VALIDATION_LAYER;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        info.pNext = &messenger;
        if (m_validation_mode == "sync")
            messenger.pNext = &features;
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateInstance(&info, nullptr, &m_instance), "vkCreateInstance");
    volkLoadInstanceOnly(m_instance);
    if (!m_validation_mode.empty()) {
        messenger.pNext = nullptr;
        check(vkCreateDebugUtilsMessengerEXT(m_instance, &messenger, nullptr, &m_messenger),
              "vkCreateDebugUtilsMessengerEXT");
    }
}

Instance::~Instance() {
    if (m_messenger)
        vkDestroyDebugUtilsMessengerEXT(m_instance, m_messenger, nullptr);
    if (m_instance)
        vkDestroyInstance(m_instance, nullptr);
}

std::vector<VkPhysicalDevice> Instance::find_physical_devices() const {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(m_instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(m_instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

void Instance::require_silent_validation() {
    std::lock_guard lock(m_log.mutex);
    if (m_log.messages.empty())
        return;
    const std::string first = m_log.messages.front();
    const std::size_t count = m_log.messages.size();
    m_log.messages.clear();
    throw DeviceError("Vulkan validation: " + first +
                      (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : ""));
}

} // namespace photonloupe::gpu
