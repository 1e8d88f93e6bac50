// SPDX-License-Identifier: Apache-2.0
// Finds and keeps what panels ask for.
#include "studio/workspace.h"

#include <algorithm>

#include "core/error.h"
#include "image/png.h"
#include "inspect/histogram.h"
#include "inspect/photon_colors.h"
#include "studio/edit_state.h"

namespace photonloupe::studio {
namespace {

constexpr const char* ENCODING = "encoding";
constexpr const char* ISOTROPY = "isotropy";
constexpr const char* PARAMETER_PREFIX = "parameter."; // of parameters that have the name of another column

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

// A few photons far out would leave the others no room: then the range is that of all but a share of them.
void leave_outliers_out(inspect::Column& column) {
    constexpr double SHARE = 0.005, MOST_ROOM = 3;
    const double low = inspect::find_quantile(column.values, SHARE);
    const double high = inspect::find_quantile(column.values, 1 - SHARE);
    if (high > low && column.high - column.low > MOST_ROOM * (high - low)) {
        column.low = static_cast<float>(low);
        column.high = static_cast<float>(high);
    }
}

bool is_parameter(const PhotonMap& map, const std::string& name) {
    return map.parameters && std::any_of(map.parameters->axes.begin(), map.parameters->axes.end(),
                                         [&](const ParameterAxis& axis) { return axis.name == name; });
}

std::vector<std::uint32_t> pack_column(const inspect::Column& column) {
    const inspect::Colormap map = inspect::choose_colormap(column);
    std::vector<std::uint32_t> colors;
    colors.reserve(column.values.size());
    for (const float value : column.values)
        colors.push_back(pack_color(inspect::map_color(map, inspect::find_color_share(column, value))));
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
    // Neighbours of every photon in parameter space take too long for a frame.
    if (name == ISOTROPY && photons->map.parameters) {
        if (photons != results.photons.get())
            throw Error("isotropy is that of the photons before relaxation; show those (Tab)");
        wants_isotropy = true;
        if (const auto error = failed.find("isotropy"); error != failed.end())
            throw Error(error->second);
        if (!results.isotropy)
            throw Error("isotropy is being measured");
        return m_columns[key] = {name, "isotropy t", results.isotropy->values, 0, 1};
    }
    inspect::Column column = inspect::find_column(device, *photons, name);
    if (!is_parameter(photons->map, name)) // bounds of parameters were declared
        leave_outliers_out(column);
    return m_columns[key] = std::move(column);
}

const inspect::Column* Workspace::seek_column(const std::string& name, std::string* missing, Photons* photons) {
    try {
        return &find_column(name, photons);
    } catch (const Error& error) {
        if (missing)
            *missing = error.what();
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

const std::vector<std::string>& Workspace::list_parameters() {
    static const std::vector<std::string> none;
    Photons* photons = shown();
    if (!photons || !photons->map.parameters)
        return none;
    std::vector<std::string>& names = m_parameters[photons];
    if (names.empty())
        names = inspect::list_parameter_columns(*photons);
    return names;
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
    if (name == ENCODING)
        return m_colors[key] = pack_encoding(photons->map);
    const inspect::Column* column = seek_column(name, nullptr, photons);
    return column ? m_colors[key] = pack_column(*column) : none; // it may be there in a later frame
}

std::string Workspace::explain_wait(const std::string& kind, const char* waiting) const {
    const auto error = failed.find(kind);
    return error == failed.end() ? waiting : error->second + "; Retry in the status line tries again";
}

void Workspace::select(Ids ids) {
    state.selection = std::move(ids);
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

Workspace::Columns Workspace::take_lasting_columns(const Photons* next) {
    const Photons* now = results.photons.get();
    Columns lasting;
    for (auto& [key, column] : m_columns)
        if (key.photons == now && key.name != ISOTROPY && !key.name.starts_with(PARAMETER_PREFIX) &&
            !is_parameter(now->map, key.name) && !is_parameter(next->map, key.name))
            lasting[{next, key.name}] = std::move(column);
    return lasting;
}

void Workspace::take_photons(std::shared_ptr<const Scene> scene, std::shared_ptr<Photons> photons,
                             bool has_same_paths) {
    Columns lasting = has_same_paths && results.photons ? take_lasting_columns(photons.get()) : Columns{};
    results.scene = std::move(scene);
    results.photons = std::move(photons);
    results.relaxed.reset();
    results.isotropy.reset();
    wants_isotropy = false;
    done.erase("isotropy");
    results.steps.clear();
    done.erase("relax");
    ++results.photons_version;
    drop_caches();
    m_columns = std::move(lasting);
    drop_unknown_ids();
    if (!state.view.camera.is_set)
        if (const std::optional<Bounds> box = find_photon_box(*results.photons, nullptr))
            fit_box(state.view.camera, *box);
}

void Workspace::drop_unknown_ids() {
    if (!results.photons)
        return;
    const std::uint64_t count = results.photons->map.count;
    std::erase_if(state.loupe.pins, [&](std::uint32_t pin) { return pin >= count; });
    const auto keep_known = [&](const Ids& ids) -> Ids {
        if (!ids || ids->empty() || ids->back() < count)
            return ids;
        auto known = std::make_shared<std::vector<std::uint32_t>>(*ids);
        std::erase_if(*known, [&](std::uint32_t id) { return id >= count; });
        return known;
    };
    select(keep_known(state.selection));
    for (auto& [name, ids] : state.named)
        ids = keep_known(ids);
}

void Workspace::take_isotropy(IsotropyResult isotropy) {
    results.isotropy = std::move(isotropy);
    ++results.photons_version; // views of the column are drawn anew
}

void Workspace::take_relaxed(std::shared_ptr<Photons> photons, std::vector<StepResult> steps) {
    results.relaxed = std::move(photons);
    results.steps = std::move(steps);
    ++results.photons_version;
    drop_caches();
}

void Workspace::drop_unwanted() {
    if (!results.relaxed || state.relax.is_wanted())
        return;
    take_relaxed(nullptr, {});
    done.erase("relax");
}

void Workspace::drop_caches() {
    m_columns.clear();
    m_colors.clear();
    m_infos.clear();
    m_parameters.clear();
    loupe.reset();
    pinned.clear();
    ++loupe_version;
}

} // namespace photonloupe::studio
