// SPDX-License-Identifier: Apache-2.0
// Finds and keeps what panels ask for.
#include "studio/workspace.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "image/png.h"
#include "inspect/colormap.h"

namespace photonloupe::studio {
namespace {

constexpr const char* ENCODING = "encoding";

std::uint32_t pack_color(glm::vec3 srgb) {
    const auto byte = [](float value) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
    };
    return byte(srgb.r) | byte(srgb.g) << 8 | byte(srgb.b) << 16 | 0xff000000u;
}

// Scripts give linear colors; photons without one are grey.
std::vector<std::uint32_t> pack_encoding(const PhotonMap& map) {
    std::vector<std::uint32_t> colors;
    if (!map.colors)
        return colors;
    colors.reserve(map.count);
    for (const glm::vec4& color : map.colors->read<glm::vec4>(map.count))
        colors.push_back(color.w > 0 ? pack_color(glm::vec3(encode_srgb(color.r, 0), encode_srgb(color.g, 0),
                                                            encode_srgb(color.b, 0)) /
                                                  255.0f)
                                     : pack_color(inspect::UNSET_COLOR));
    return colors;
}

std::vector<std::uint32_t> pack_column(const inspect::Column& column) {
    const inspect::Colormap map = column.period > 0 ? inspect::Colormap::twilight : inspect::Colormap::viridis;
    const float span = column.high > column.low ? column.high - column.low : 1.0f;
    std::vector<std::uint32_t> colors;
    colors.reserve(column.values.size());
    for (const float value : column.values)
        colors.push_back(pack_color(inspect::map_color(map, (value - column.low) / span)));
    return colors;
}

} // namespace

Photons* Workspace::shown(bool relaxed) const {
    return relaxed && results.relaxed ? results.relaxed.get() : results.photons.get();
}

Photons* Workspace::shown() const {
    return shown(state.view.shows_relaxed);
}

const inspect::Column& Workspace::find_column(const std::string& name, Photons* photons) {
    photons = photons ? photons : shown();
    if (!photons)
        throw Error("there are no photons yet; open a scene");
    const ColumnKey key{photons, name};
    const auto found = m_columns.find(key);
    if (found != m_columns.end())
        return found->second;
    return m_columns[key] = inspect::find_column(bench, *photons, name);
}

const inspect::Column* Workspace::seek_column(const std::string& name, std::string& missing, Photons* photons) {
    try {
        return &find_column(name, photons);
    } catch (const Error& error) {
        missing = error.what();
        return nullptr;
    }
}

const std::vector<inspect::ColumnInfo>& Workspace::list_columns() {
    static const std::vector<inspect::ColumnInfo> none;
    Photons* photons = shown();
    if (!photons)
        return none;
    std::vector<inspect::ColumnInfo>& infos = m_infos[photons];
    if (infos.empty())
        infos = inspect::list_columns(*photons);
    return infos;
}

const std::vector<std::uint32_t>& Workspace::find_colors(const std::string& name, Photons* photons) {
    static const std::vector<std::uint32_t> none;
    photons = photons ? photons : shown();
    if (!photons)
        return none;
    const ColumnKey key{photons, name};
    const auto found = m_colors.find(key);
    if (found != m_colors.end())
        return found->second;
    std::string missing;
    const inspect::Column* column = name == ENCODING ? nullptr : seek_column(name, missing, photons);
    return m_colors[key] = name == ENCODING ? pack_encoding(photons->map)
                           : column         ? pack_column(*column)
                                            : std::vector<std::uint32_t>{};
}

void Workspace::select(Ids ids) {
    state.selection = ids && !ids->empty() ? std::move(ids) : nullptr;
    ++selection_version;
}

Ids Workspace::find_source(const std::string& source) {
    if (source == "selection")
        return state.selection;
    if (source != "loupe" || !loupe)
        return nullptr;
    std::vector<std::uint32_t> ids = loupe->ids;
    std::sort(ids.begin(), ids.end());
    return std::make_shared<const std::vector<std::uint32_t>>(std::move(ids));
}

void Workspace::drop_caches() {
    m_columns.clear();
    m_colors.clear();
    m_infos.clear();
    loupe.reset();
    pinned.clear();
    ++loupe_version;
}

} // namespace photonloupe::studio
