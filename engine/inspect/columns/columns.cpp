// SPDX-License-Identifier: Apache-2.0
// Finds a column's source by name and fills in range and kind.
#include "inspect/columns/columns.h"

#include <cmath>
#include <set>

#include "inspect/columns/column_source.h"
#include "inspect/photon_colors.h"
#include "relax/isotropy.h"

namespace photonloupe::inspect {
namespace {

// Whole numbers of no more values than these count as discrete: a signature or a cluster that a script numbers.
constexpr std::size_t MOST_DISCRETE = 64;

std::vector<ColumnSource> list_sources(const Photons& photons) {
    std::vector<ColumnSource> sources;
    list_photon_sources(sources);
    list_path_sources(sources);
    list_state_sources(sources);
    list_parameter_sources(sources, photons);
    return sources;
}

std::string explain_missing(const Photons& photons, const ColumnSource& source) {
    const RelaxedState* state = photons.state.get();
    switch (source.needs) {
    case Needs::nothing:
        return {};
    case Needs::paths:
        return photons.map.paths ? "" : "the map has no paths; record them when tracing, or give them to from_arrays";
    case Needs::parameters:
        return photons.map.parameters ? "" : "the map has no parameters; run a script that declares some, or set them";
    case Needs::constraint:
        return state && state->basis.size() == 6 * photons.map.count
                   ? ""
                   : "the map has no constraint; constrain or relax the photons with a descriptor first";
    case Needs::relaxation:
        return state && state->drift.size() == 3 * photons.map.count
                   ? ""
                   : "the map was not relaxed; constrain or relax the photons first";
    }
    return {};
}

void fill_range(Column& column) {
    bool is_first = true;
    for (const float value : column.values) {
        if (!std::isfinite(value))
            continue;
        column.low = is_first ? value : std::min(column.low, value);
        column.high = is_first ? value : std::max(column.high, value);
        is_first = false;
    }
}

bool are_few_whole_numbers(const std::vector<float>& values) {
    std::set<float> met;
    for (const float value : values) {
        if (!std::isfinite(value))
            continue;
        if (value != std::trunc(value))
            return false;
        if (met.insert(value); met.size() > MOST_DISCRETE)
            return false;
    }
    return !met.empty();
}

} // namespace

std::vector<ColumnInfo> list_columns(const Photons& photons) {
    std::vector<ColumnInfo> infos;
    for (const ColumnSource& source : list_sources(photons))
        infos.push_back({source.name, source.label, source.period, source.is_discrete, source.needs == Needs::paths,
                         explain_missing(photons, source)});
    return infos;
}

std::vector<glm::vec3> find_photon_colors(gpu::Device& device, Photons& photons, const std::string& color,
                                          const Progress& progress) {
    return color == "encoding" ? list_encoded_colors(photons.map)
                               : list_column_colors(find_column(device, photons, color, progress));
}

Column find_column(gpu::Device& device, Photons& photons, const std::string& name, const Progress& progress) {
    std::string names;
    for (const ColumnSource& source : list_sources(photons)) {
        names += (names.empty() ? "" : ", ") + source.name;
        if (source.name != name)
            continue;
        if (const std::string missing = explain_missing(photons, source); !missing.empty())
            throw Error("column '" + name + "': " + missing);
        Column column{name, source.label, {}, source.low, source.high, source.period, source.is_discrete};
        column.values = source.compute ? source.compute(photons)
                                       : measure_isotropy(device, *find_parameter_tree(device, photons, progress),
                                                          ISOTROPY_NEIGHBORS, progress);
        if (!(source.high > source.low))
            fill_range(column);
        if (source.needs == Needs::parameters && source.compute && source.period == 0)
            column.is_discrete = are_few_whole_numbers(column.values);
        return column;
    }
    throw Error("there is no column '" + name + "'; the columns are " + names);
}

std::vector<std::string> list_parameter_columns(const Photons& photons) {
    const std::size_t count = photons.map.parameters ? photons.map.parameters->axes.size() : 0;
    const std::vector<ColumnSource> sources = list_sources(photons); // those of parameters stand last
    std::vector<std::string> names;
    for (std::size_t i = sources.size() - count; i < sources.size(); ++i)
        names.push_back(sources[i].name);
    return names;
}

} // namespace photonloupe::inspect
