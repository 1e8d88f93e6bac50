// SPDX-License-Identifier: Apache-2.0
// Keeps the host's copy of a script's columns and knows which copy is newer.
#include "script/interpret/script_columns.h"

#include <algorithm>
#include <bit>

namespace photonloupe::script {

float make_unset() {
    return std::bit_cast<float>(UNSET_BITS);
}

bool is_unset(float value) {
    return std::bit_cast<std::uint32_t>(value) == UNSET_BITS;
}

void ScriptColumns::take_to_host() {
    m_is_on_host = true;
    m_parameters.resize(m_declared.size());
    for (std::vector<float>& column : m_parameters)
        if (column.size() != m_photon_count)
            column.assign(m_photon_count, make_unset());
    if (m_colors.size() != 3 * m_photon_count)
        m_colors.assign(3 * m_photon_count, make_unset());
    if (m_device_is_newer && m_download) {
        m_device_is_newer = false; // the download asks for the arrays itself
        m_download(*this);
        note_same();
    }
}

void ScriptColumns::declare(std::uint32_t dimension, DeclaredParameter parameter) {
    const std::size_t index = dimension - FIRST_DIMENSION;
    ++m_version;
    if (m_device_is_newer)
        take_to_host();
    if (m_declared.size() <= index)
        m_declared.resize(index + 1);
    m_declared[index] = std::move(parameter);
    if (!m_is_on_host)
        return;
    take_to_host();
    std::fill(m_parameters[index].begin(), m_parameters[index].end(), make_unset());
    m_host_is_newer = true;
}

bool ScriptColumns::drop_behind_gap() {
    const auto gap = std::find_if(m_declared.begin(), m_declared.end(),
                                  [](const DeclaredParameter& parameter) { return !(parameter.low < parameter.high); });
    if (gap == m_declared.end())
        return false;
    if (m_device_is_newer)
        take_to_host();
    m_declared.erase(gap, m_declared.end());
    m_parameters.resize(std::min(m_parameters.size(), m_declared.size()));
    m_host_is_newer = m_host_is_newer || m_is_on_host;
    ++m_version;
    return true;
}

float ScriptColumns::read_parameter(std::size_t index, std::uint64_t photon) {
    if (!m_is_on_host || m_device_is_newer)
        take_to_host();
    return m_parameters[index][photon];
}

void ScriptColumns::write_parameter(std::size_t index, std::uint64_t photon, float value) {
    if (!m_is_on_host || m_device_is_newer)
        take_to_host();
    ++m_version;
    m_parameters[index][photon] = value;
    m_host_is_newer = true;
}

void ScriptColumns::write_color(std::uint64_t photon, const float (&color)[3]) {
    if (!m_is_on_host || m_device_is_newer)
        take_to_host();
    std::copy_n(color, 3, m_colors.begin() + static_cast<std::ptrdiff_t>(3 * photon));
    m_has_colors = m_host_is_newer = true;
}

std::vector<std::vector<float>>& ScriptColumns::host_parameters() {
    if (!m_is_on_host || m_device_is_newer)
        take_to_host();
    return m_parameters;
}

std::vector<float>& ScriptColumns::host_colors() {
    if (!m_is_on_host || m_device_is_newer)
        take_to_host();
    return m_colors;
}

} // namespace photonloupe::script
