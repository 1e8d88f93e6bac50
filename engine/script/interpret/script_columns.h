// SPDX-License-Identifier: Apache-2.0
// The columns a script writes: parameters and colors, on the host and on the device, whichever has them newer.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace photonloupe::script {

constexpr std::uint32_t FIRST_DIMENSION = 3; // 0–2 are x, y, z
constexpr std::uint32_t LAST_DIMENSION = 15;
constexpr std::uint32_t PARAMETER_LIMIT = LAST_DIMENSION - FIRST_DIMENSION + 1;

// A value where nothing was set: a NaN that arithmetic does not make, so that "set to NaN" can be told apart.
constexpr std::uint32_t UNSET_BITS = 0x7fffffffu;
float make_unset();
bool is_unset(float value);

struct DeclaredParameter {
    std::string name;
    float low = 0, high = 0;
    bool is_periodic = false;
};

// The host's arrays are made when somebody on the host asks; until then what is declared is unset everywhere.
class ScriptColumns {
public:
    explicit ScriptColumns(std::uint64_t photon_count = 0) : m_photon_count(photon_count) {}

    // Replaces the dimension's parameter if there is one: it is unset again.
    void declare(std::uint32_t dimension, DeclaredParameter parameter);
    const std::vector<DeclaredParameter>& declared() const { return m_declared; } // dimensions from 3 on
    // Dimensions behind the first that is not declared (a declaration may come before that of a lower one) are dropped.
    // True: there were such.
    bool drop_behind_gap();

    float read_parameter(std::size_t index, std::uint64_t photon); // index: dimension - 3
    void write_parameter(std::size_t index, std::uint64_t photon, float value);
    void write_color(std::uint64_t photon, const float (&color)[3]);

    // By dimension - 3; rgb a photon. For whoever moves them to or from the device.
    std::vector<std::vector<float>>& host_parameters();
    std::vector<float>& host_colors();

    bool has_colors() const { return m_has_colors; } // some photon may have been given one
    void note_colors() { m_has_colors = true; }
    // Grows with every write, whoever made it.
    std::uint64_t version() const { return m_version; }
    bool is_on_host() const { return m_is_on_host; } // arrays were made
    bool host_is_newer() const { return m_host_is_newer; }
    void note_device_wrote() {
        m_device_is_newer = true;
        ++m_version;
    }
    void note_same() { m_host_is_newer = m_device_is_newer = false; }
    // Called when the host wants what the device has newer.
    void set_download(std::function<void(ScriptColumns&)> download) { m_download = std::move(download); }

private:
    void take_to_host();

    std::uint64_t m_photon_count;
    std::vector<DeclaredParameter> m_declared;
    std::vector<std::vector<float>> m_parameters;
    std::vector<float> m_colors;
    std::uint64_t m_version = 0;
    bool m_has_colors = false, m_is_on_host = false, m_host_is_newer = false, m_device_is_newer = false;
    std::function<void(ScriptColumns&)> m_download;
};

} // namespace photonloupe::script
