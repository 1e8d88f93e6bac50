// SPDX-License-Identifier: Apache-2.0
// Moves a script's columns between host and device.
#include "script/run/device_columns.h"

#include <algorithm>

#include <glm/vec4.hpp>

#include "gpu/commands.h"

namespace photonloupe::script {

DeviceColumns::DeviceColumns(gpu::Device& device, std::uint64_t photon_count, ScriptColumns& columns)
    : m_device(device), m_photon_count(photon_count), m_columns(columns) {
    columns.set_download([this](ScriptColumns& target) { download(target); });
}

void DeviceColumns::allocate(gpu::Buffer& buffer, std::uint64_t size_bytes, const char* purpose) {
    buffer = gpu::Buffer(m_device, std::max<std::uint64_t>(size_bytes, sizeof(glm::vec4)), purpose);
    gpu::fill(m_device, "clear columns", buffer, UNSET_BITS);
}

void DeviceColumns::prepare() {
    const std::size_t dimensions = m_columns.declared().size();
    const bool grows = m_parameters.is_empty() || dimensions > m_dimensions;
    if (grows) {
        allocate(m_parameters, dimensions * m_photon_count * sizeof(float), "script parameters");
        m_dimensions = dimensions;
    }
    if (m_colors.is_empty())
        allocate(m_colors, m_photon_count * sizeof(glm::vec4), "script colors");
    if (m_columns.is_on_host() && (grows || m_columns.host_is_newer()))
        upload();
}

void DeviceColumns::upload() {
    const std::vector<std::vector<float>>& parameters = m_columns.host_parameters();
    for (std::size_t i = 0; i < parameters.size(); ++i)
        m_parameters.upload(parameters[i].data(), m_photon_count * sizeof(float), i * m_photon_count * sizeof(float));
    const std::vector<float>& colors = m_columns.host_colors();
    std::vector<glm::vec4> packed(m_photon_count);
    for (std::size_t i = 0; i < packed.size(); ++i)
        packed[i] = {colors[3 * i], colors[3 * i + 1], colors[3 * i + 2],
                     is_unset(colors[3 * i]) ? make_unset() : 1.0f};
    m_colors.upload(packed.data(), packed.size() * sizeof(glm::vec4));
    m_columns.note_same();
}

void DeviceColumns::download(ScriptColumns& columns) const {
    std::vector<std::vector<float>>& parameters = columns.host_parameters();
    for (std::size_t i = 0; i < std::min(parameters.size(), m_dimensions); ++i)
        m_parameters.download(parameters[i].data(), m_photon_count * sizeof(float), i * m_photon_count * sizeof(float));
    std::vector<float>& colors = columns.host_colors();
    const std::vector<glm::vec4> packed = m_colors.read<glm::vec4>(m_photon_count);
    for (std::size_t i = 0; i < packed.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            colors[3 * i + channel] = packed[i].w == 1.0f ? packed[i][channel] : make_unset();
}

} // namespace photonloupe::script
