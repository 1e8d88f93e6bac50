// SPDX-License-Identifier: Apache-2.0
// Columns every map has (places, normals, flux, numbers), and its parameters.
#include <algorithm>
#include <bit>
#include <limits>
#include <set>

#include "inspect/columns/column_source.h"
#include "inspect/photon_colors.h"
#include "script/interpret/script_columns.h"
#include "shared/trace.h"

namespace photonloupe::inspect {
namespace {

constexpr float NO_VALUE = std::numeric_limits<float>::quiet_NaN();

using Packed = gpu::Buffer PhotonMap::*;

// A number of each packed element of a column.
template <class Read>
auto read_each(Packed column, const Read& read) {
    return [column, read](const Photons& photons) {
        std::vector<float> values(photons.map.count);
        const std::vector<glm::vec4> packed = (photons.map.*column).read<glm::vec4>(photons.map.count);
        std::transform(packed.begin(), packed.end(), values.begin(), read);
        return values;
    };
}

auto read_component(Packed column, std::size_t i) {
    return read_each(column, [i](const glm::vec4& packed) { return packed[i]; });
}

auto read_world(std::size_t axis) {
    return [axis](const Photons& photons) {
        const double origin = photons.map.origin[axis];
        std::vector<float> values = read_component(&PhotonMap::position_emitter, axis)(photons);
        for (float& value : values)
            value = static_cast<float>(value + origin);
        return values;
    };
}

std::uint32_t read_bits(const glm::vec4& packed) {
    return std::bit_cast<std::uint32_t>(packed.w);
}

float read_object(const glm::vec4& packed) {
    return read_bits(packed) == shared::NO_OBJECT ? NO_VALUE : static_cast<float>(read_bits(packed));
}

auto read_parameter(std::uint32_t i) {
    return [i](const Photons& photons) {
        const ParameterColumns& columns = *photons.map.parameters;
        const std::size_t rows = columns.count_rows();
        const std::vector<glm::vec4> packed = columns.values.read<glm::vec4>(photons.map.count * rows);
        std::vector<float> values(photons.map.count);
        for (std::size_t photon = 0; photon < values.size(); ++photon)
            values[photon] = packed[photon * rows + i / 4][i % 4];
        return values;
    };
}

} // namespace

void list_photon_sources(std::vector<ColumnSource>& sources) {
    const auto add = [&](const char* name, const char* label, std::function<std::vector<float>(const Photons&)> compute,
                         bool is_discrete = false) {
        sources.push_back({name, label, Needs::nothing, 0, 0, 0, is_discrete, std::move(compute)});
    };
    add("x", "x [m]", read_world(0));
    add("y", "y [m]", read_world(1));
    add("z", "z [m]", read_world(2));
    add("nx", "normal x", read_component(&PhotonMap::normal_index, 0));
    add("ny", "normal y", read_component(&PhotonMap::normal_index, 1));
    add("nz", "normal z", read_component(&PhotonMap::normal_index, 2));
    add("power", "flux, luminance [W]",
        read_each(&PhotonMap::power_object, [](const glm::vec4& packed) { return find_luminance(glm::vec3(packed)); }));
    add("red", "flux, red [W]", read_component(&PhotonMap::power_object, 0));
    add("green", "flux, green [W]", read_component(&PhotonMap::power_object, 1));
    add("blue", "flux, blue [W]", read_component(&PhotonMap::power_object, 2));
    add("emitter", "emitter",
        read_each(&PhotonMap::position_emitter,
                  [](const glm::vec4& packed) { return static_cast<float>(read_bits(packed)); }),
        true);
    add("object", "object", read_each(&PhotonMap::power_object, read_object), true);
    add("emitted_index", "emitted index", read_each(&PhotonMap::normal_index, [](const glm::vec4& packed) {
            return static_cast<float>(read_bits(packed));
        }));
}

void list_parameter_sources(std::vector<ColumnSource>& sources, const Photons& photons) {
    if (!photons.map.parameters)
        return;
    std::set<std::string> taken;
    for (const ColumnSource& source : sources)
        taken.insert(source.name);
    const std::vector<ParameterAxis>& axes = photons.map.parameters->axes;
    for (std::uint32_t i = 0; i < axes.size(); ++i) {
        std::string name = axes[i].name;
        if (taken.contains(name))
            name = "parameter." + name;
        if (axes[i].name.empty() || taken.contains(name))
            name = "parameter." + std::to_string(i + script::FIRST_DIMENSION);
        taken.insert(name);
        sources.push_back({name, axes[i].name.empty() ? name : axes[i].name, Needs::parameters,
                           static_cast<float>(axes[i].low), static_cast<float>(axes[i].high),
                           static_cast<float>(axes[i].period), false, read_parameter(i)});
    }
}

} // namespace photonloupe::inspect
