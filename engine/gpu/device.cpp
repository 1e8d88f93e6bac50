// SPDX-License-Identifier: Apache-2.0
// Lists, chooses and opens a Vulkan device.
#include "gpu/device.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/error.h"
#include "gpu/device_impl.h"
#include "gpu/driver_cache.h"

namespace photonloupe::gpu {
namespace {

// The largest share of what is free that one program may take: the rest is for the system and the driver's own needs.
constexpr double USABLE_MEMORY_SHARE = 0.9;
// A step down the kd-tree gives each of eight descendants a lane (TREE_FANOUT); fewer lanes would miss some silently.
constexpr std::uint32_t SMALLEST_SUBGROUP = 8;
// Warps of 64 (AMD) are the widest subgroups in use; a kernel's workgroup is one subgroup or a multiple of it.
constexpr std::uint32_t LARGEST_SUBGROUP = 128;
constexpr std::uint64_t TEXEL_BYTES = 16; // RGBA32F

struct Properties {
    VkPhysicalDeviceProperties2 base{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
};

Properties read_properties(VkPhysicalDevice device) {
    Properties properties;
    vkGetPhysicalDeviceProperties(device, &properties.base.properties);
    if (properties.base.properties.apiVersion < VK_API_VERSION_1_2)
        return properties;
    properties.v11.pNext = &properties.v12;
    properties.base.pNext = &properties.v11;
    vkGetPhysicalDeviceProperties2(device, &properties.base);
    return properties;
}

struct Features {
    VkPhysicalDeviceFeatures2 base{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
};

Features read_features(VkPhysicalDevice device) {
    Features features;
    features.base.pNext = &features.v12;
    vkGetPhysicalDeviceFeatures2(device, &features.base);
    return features;
}

std::uint32_t find_queue(VkPhysicalDevice device, VkQueueFlags flags) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t index = 0; index < count; ++index)
        if ((families[index].queueFlags & flags) == flags)
            return index;
    return UINT32_MAX;
}

// One that draws the interface too, where there is one.
std::uint32_t find_compute_queue(VkPhysicalDevice device) {
    const std::uint32_t drawing = find_queue(device, VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT);
    return drawing != UINT32_MAX ? drawing : find_queue(device, VK_QUEUE_COMPUTE_BIT);
}

bool has_extension(VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
          "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> there(count);
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, there.data()),
          "vkEnumerateDeviceExtensionProperties");
    return std::any_of(there.begin(), there.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

// Whether the interface can be drawn: graphics on the compute queue, into images that need no render pass.
bool can_draw(VkPhysicalDevice device) {
    return find_queue(device, VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT) != UINT32_MAX &&
           has_extension(device, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
}

// The first thing this device lacks, or empty.
std::string find_missing_requirement(VkPhysicalDevice device, const Properties& properties) {
    if (properties.base.properties.apiVersion < VK_API_VERSION_1_2)
        return "needs Vulkan 1.2";
    if (find_compute_queue(device) == UINT32_MAX)
        return "has no compute queue";
    if (!read_features(device).v12.bufferDeviceAddress)
        return "lacks bufferDeviceAddress";
    const VkSubgroupFeatureFlags needed =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    if ((properties.v11.subgroupSupportedOperations & needed) != needed)
        return "lacks subgroup arithmetic or shuffle";
    if (properties.v11.subgroupSize < SMALLEST_SUBGROUP)
        return "has subgroups narrower than 8";
    if (!properties.v12.shaderSignedZeroInfNanPreserveFloat32)
        return "cannot keep NaN, inf and signed zero in 32-bit floats";
    return {};
}

std::string name_type(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "software";
    default:
        return "other";
    }
}

std::uint64_t sum_device_memory(VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    std::uint64_t total = 0;
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap)
        if (memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            total += memory.memoryHeaps[heap].size;
    return total;
}

DeviceInfo describe_device(VkPhysicalDevice device, int index) {
    const Properties properties = read_properties(device);
    const VkPhysicalDeviceProperties& base = properties.base.properties;
    DeviceInfo info;
    info.index = index;
    info.name = base.deviceName;
    info.type = name_type(base.deviceType);
    info.driver = std::string(properties.v12.driverName) + " " + properties.v12.driverInfo;
    info.api_version = std::to_string(VK_API_VERSION_MAJOR(base.apiVersion)) + "." +
                       std::to_string(VK_API_VERSION_MINOR(base.apiVersion)) + "." +
                       std::to_string(VK_API_VERSION_PATCH(base.apiVersion));
    info.memory_bytes = sum_device_memory(device);
    info.reason = find_missing_requirement(device, properties);
    info.usable = info.reason.empty();
    return info;
}

std::vector<DeviceInfo> describe_devices(const Instance& instance) {
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice device : instance.find_physical_devices())
        infos.push_back(describe_device(device, static_cast<int>(infos.size())));
    return infos;
}

std::string list_names(const std::vector<DeviceInfo>& infos) {
    std::string text;
    for (const DeviceInfo& info : infos)
        text += (text.empty() ? "" : ", ") + std::to_string(info.index) + ": " + info.name +
                (info.usable ? "" : " (" + info.reason + ")");
    return text.empty() ? "none" : text;
}

std::pair<int, std::string> choose_device(const std::vector<DeviceInfo>& infos, const std::string& selector) {
    if (infos.empty())
        throw DeviceError("the Vulkan loader reports no device; install a driver, for example mesa-vulkan-drivers "
                          "for the software device");
    if (selector == "auto" || selector.empty()) {
        for (const char* type : {"discrete", "integrated", "virtual", "other", "software"})
            for (const DeviceInfo& info : infos)
                if (info.usable && info.type == type)
                    return {info.index, std::string("first usable device of type ") + type};
        throw DeviceError("no usable Vulkan device; found " + list_names(infos));
    }
    int index = -1;
    const auto [end, error] = std::from_chars(selector.data(), selector.data() + selector.size(), index);
    const bool is_index = error == std::errc() && end == selector.data() + selector.size();
    for (const DeviceInfo& info : infos)
        if (is_index ? info.index == index : info.name.find(selector) != std::string::npos) {
            if (!info.usable)
                throw DeviceError("device '" + info.name + "' " + info.reason +
                                  "; choose another: " + list_names(infos));
            return {info.index, "asked for by '" + selector + "'"};
        }
    throw DeviceError("no device matches '" + selector + "'; there are " + list_names(infos));
}

// Some GPUs vary the subgroup's width from kernel to kernel; where they do, kernels ask for the reported one.
bool can_fix_subgroup_size(VkPhysicalDevice device, const Properties& properties) {
    if (properties.base.properties.apiVersion < VK_API_VERSION_1_3)
        return false;
    VkPhysicalDeviceSubgroupSizeControlFeatures control{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &control};
    vkGetPhysicalDeviceFeatures2(device, &features);
    VkPhysicalDeviceSubgroupSizeControlProperties sizes{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES};
    VkPhysicalDeviceProperties2 query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes};
    vkGetPhysicalDeviceProperties2(device, &query);
    return control.subgroupSizeControl && sizes.minSubgroupSize != sizes.maxSubgroupSize &&
           (sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT);
}

bool is_staging_forced() {
    const char* value = std::getenv("PHOTONLOUPE_FORCE_STAGING");
    return value && *value && std::strcmp(value, "0") != 0;
}

std::uint32_t find_memory_type(const VkPhysicalDeviceMemoryProperties& memory, VkMemoryPropertyFlags flags) {
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if ((memory.memoryTypes[type].propertyFlags & flags) == flags)
            return type;
    return UINT32_MAX;
}

void choose_memory_types(Device::Impl& impl) {
    vkGetPhysicalDeviceMemoryProperties(impl.physical, &impl.memory);
    const VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    const VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags cached = host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    // Only where the processor's memory is the device's is reading in place fast.
    const bool shares_memory = impl.info.type == "software" || impl.info.type == "integrated";
    const std::uint32_t shared = find_memory_type(impl.memory, local | cached);
    impl.limits.host_visible = shares_memory && shared != UINT32_MAX && !is_staging_forced();
    impl.memory_type_main = impl.limits.host_visible ? shared : find_memory_type(impl.memory, local);
    impl.memory_type_staging = find_memory_type(impl.memory, cached);
    if (impl.memory_type_staging == UINT32_MAX)
        impl.memory_type_staging = find_memory_type(impl.memory, host);
    if (impl.memory_type_main == UINT32_MAX || impl.memory_type_staging == UINT32_MAX)
        throw DeviceError("device '" + impl.info.name + "' offers no memory the host can reach");
}

void read_limits(Device::Impl& impl) {
    const Properties properties = read_properties(impl.physical);
    const VkPhysicalDeviceLimits& limits = properties.base.properties.limits;
    VkPhysicalDeviceMaintenance3Properties maintenance{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &maintenance};
    vkGetPhysicalDeviceProperties2(impl.physical, &query);
    impl.limits.subgroup_size = std::min(properties.v11.subgroupSize, LARGEST_SUBGROUP);
    impl.fixes_subgroup_size = can_fix_subgroup_size(impl.physical, properties);
    impl.limits.max_storage_range = limits.maxStorageBufferRange;
    impl.limits.max_texel_count = limits.maxTexelBufferElements;
    if (const char* forced = std::getenv("PHOTONLOUPE_STORAGE_RANGE")) { // bytes; for tests of large buffers
        const std::uint64_t range = std::strtoull(forced, nullptr, 10);
        impl.limits.max_storage_range = std::min(impl.limits.max_storage_range, range);
        impl.limits.max_texel_count = std::min(impl.limits.max_texel_count, range / TEXEL_BYTES);
    }
    impl.limits.max_allocation_bytes = maintenance.maxMemoryAllocationSize;
    impl.limits.max_group_count = limits.maxComputeWorkGroupCount[0];
    impl.timestamp_nanoseconds = limits.timestampComputeAndGraphics ? limits.timestampPeriod : 0.0;
}

void create_logical_device(Device::Impl& impl) {
    const Features supported = read_features(impl.physical);
    VkPhysicalDeviceSubgroupSizeControlFeatures subgroups{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES};
    subgroups.subgroupSizeControl = VK_TRUE;
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    v12.bufferDeviceAddress = VK_TRUE;
    v12.pNext = impl.fixes_subgroup_size ? &subgroups : nullptr;
    VkPhysicalDeviceDynamicRenderingFeaturesKHR drawing{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES_KHR, v12.pNext, VK_TRUE};
    std::vector<const char*> extensions;
    if (impl.limits.can_draw) {
        v12.pNext = &drawing;
        extensions.push_back(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    }
    if (impl.limits.can_draw && has_extension(impl.physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        impl.limits.can_present = true;
    }
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    features.features.robustBufferAccess = supported.base.features.robustBufferAccess;
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = impl.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateDevice(impl.physical, &info, nullptr, &impl.device), "vkCreateDevice");
    volkLoadDeviceTable(&impl.table, impl.device);
    impl.table.vkGetDeviceQueue(impl.device, impl.queue_family, 0, &impl.queue);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = impl.queue_family;
    check(impl.table.vkCreateCommandPool(impl.device, &pool, nullptr, &impl.command_pool), "vkCreateCommandPool");
}

// What the host could still give; 0 when the system does not say.
std::uint64_t read_available_host_bytes() {
    std::ifstream file("/proc/meminfo");
    std::string key, unit;
    std::uint64_t kibibytes = 0;
    while (file >> key >> kibibytes >> unit)
        if (key == "MemAvailable:")
            return kibibytes * 1024;
    return 0;
}

} // namespace

std::vector<DeviceInfo> list_devices() {
    return describe_devices(*Instance::acquire());
}

Device::Device(const std::string& selector) : m_impl(std::make_unique<Impl>()) {
    m_impl->instance = Instance::acquire();
    const std::vector<DeviceInfo> infos = describe_devices(*m_impl->instance);
    const auto [index, because] = choose_device(infos, selector);
    m_impl->info = infos[static_cast<std::size_t>(index)];
    m_impl->chosen_because = because;
    m_impl->physical = m_impl->instance->find_physical_devices()[static_cast<std::size_t>(index)];
    m_impl->queue_family = find_compute_queue(m_impl->physical);
    read_limits(*m_impl);
    m_impl->limits.can_draw = can_draw(m_impl->physical);
    choose_memory_types(*m_impl);
    create_logical_device(*m_impl);
    m_impl->pipeline_cache = load_pipeline_cache(*m_impl);
    m_impl->ahead = std::make_unique<CompileAhead>(*m_impl);
}

Device::~Device() {
    if (m_impl->ahead && m_impl->ahead->is_abandoned())
        static_cast<void>(m_impl.release());
}

Device::Impl::~Impl() {
    ahead.reset(); // its threads use all that follows
    if (!device)
        return;
    // After a missed deadline the work may still be running: its objects must outlive it, so they are left to the
    // process's end.
    if (!lost_because.empty())
        return;
    save_pipeline_cache(*this);
    kernels.clear();
    table.vkDestroyPipelineCache(device, pipeline_cache, nullptr);
    table.vkDestroyCommandPool(device, command_pool, nullptr);
    table.vkDestroyDevice(device, nullptr);
}

void Device::Impl::require_alive() const {
    if (!lost_because.empty())
        throw DeviceError("this device can no longer be used (" + lost_because + "); open a new Device");
}

const DeviceInfo& Device::info() const {
    return m_impl->info;
}
const DeviceLimits& Device::limits() const {
    return m_impl->limits;
}
const std::string& Device::chosen_because() const {
    return m_impl->chosen_because;
}
std::string Device::validation_mode() const {
    return m_impl->instance->validation_mode();
}
std::uint64_t Device::allocated_bytes() const {
    return m_impl->allocated_bytes;
}

std::uint64_t Device::available_bytes() const {
    const std::uint64_t allocated = m_impl->allocated_bytes;
    std::uint64_t available = m_impl->info.memory_bytes - std::min(m_impl->info.memory_bytes, allocated);
    const std::uint64_t host = read_available_host_bytes();
    if (m_impl->info.type == "software" && host > 0)
        available = host; // its heap is the host's memory, whatever size it reports
    else if (m_impl->limits.host_visible && host > 0)
        available = std::min(available, host);
    if (const char* cap = std::getenv("PHOTONLOUPE_MEMORY_LIMIT")) { // bytes; lets a shared machine keep its share
        const std::uint64_t limit = std::strtoull(cap, nullptr, 10);
        available = std::min(available, limit - std::min(limit, allocated));
    }
    return static_cast<std::uint64_t>(static_cast<double>(available) * USABLE_MEMORY_SHARE);
}

void Device::set_chunk_milliseconds(double milliseconds) {
    m_impl->chunk_milliseconds = milliseconds;
}
double Device::chunk_milliseconds() const {
    return m_impl->chunk_milliseconds;
}

void Device::record_timing(const std::string& stage, double milliseconds, std::uint64_t dispatch_count) {
    std::lock_guard lock(m_impl->mutex);
    StageTiming& timing = m_impl->timings[stage];
    timing.milliseconds += milliseconds;
    timing.dispatch_count += dispatch_count;
}

std::map<std::string, StageTiming> Device::take_timings() {
    std::lock_guard lock(m_impl->mutex);
    return std::exchange(m_impl->timings, {});
}

} // namespace photonloupe::gpu
