// SPDX-License-Identifier: Apache-2.0
// Binds the tables of settings: what each stage can be told, and what automatic settings stand for.
#include "settings.h"

#include "inspect/settings.h"

namespace photonloupe::bindings {
namespace {

SettingValue read_value(nb::handle given) {
    if (given.is_none())
        return {};
    if (nb::isinstance<nb::bool_>(given))
        return nb::cast<bool>(given);
    if (nb::isinstance<nb::int_>(given) || nb::isinstance<nb::float_>(given))
        return nb::cast<double>(given);
    if (nb::isinstance<nb::str>(given))
        return nb::cast<std::string>(given);
    return nb::cast<std::vector<double>>(given);
}

nb::object write_value(const Setting& setting) {
    const SettingValue value = setting.read(setting);
    if (std::holds_alternative<std::monostate>(value))
        return nb::none();
    if (setting.kind == SettingKind::count)
        return nb::int_(static_cast<std::uint64_t>(std::get<double>(value)));
    return std::visit(
        [](const auto& held) -> nb::object {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
                return nb::none();
            else
                return nb::cast(held);
        },
        value);
}

nb::list describe_rows(const std::vector<Setting>& rows) {
    static constexpr const char* KINDS[] = {"flag", "count", "number", "numbers", "choice"};
    return list_rows(rows, [](const Setting& setting) {
        const SettingInfo& about = setting.about;
        return make_row("name"_a = about.name, "kind"_a = KINDS[static_cast<std::size_t>(setting.kind)],
                        "default"_a = write_value(setting), "doc"_a = about.doc, "low"_a = about.range.low,
                        "high"_a = about.range.high, "choices"_a = about.choices, "width"_a = setting.width,
                        "empty"_a = about.empty, "automatic"_a = about.automatic, "alias"_a = about.alias,
                        "unit"_a = about.unit, "spreads"_a = about.spreads, "differs"_a = about.differs);
    });
}

// Hands a stage's default settings on.
template <class Use>
auto with_stage(const std::string& stage, const Use& use) {
    if (stage == "trace")
        return use(TraceSettings{});
    if (stage == "relax")
        return use(RelaxSettings{});
    if (stage == "irradiance")
        return use(EstimateSettings{});
    if (stage == "render")
        return use(RenderSettings{});
    if (stage == "loupe")
        return use(inspect::LoupeSettings{});
    throw Error("stage is '" + stage + "'; it must be trace, relax, irradiance, render or loupe");
}

} // namespace

nb::dict write_rows(const std::vector<Setting>& rows) {
    nb::dict values;
    for (const Setting& setting : rows)
        values[setting.about.name.c_str()] = write_value(setting);
    return values;
}

void read_rows(const std::vector<Setting>& rows, const nb::dict& given) {
    for (const Setting& setting : rows)
        if (given.contains(setting.about.name.c_str()))
            write_setting(setting, read_value(given[setting.about.name.c_str()]));
}

void bind_settings(nb::module_& module) {
    module.def(
        "describe_settings",
        [](const std::string& stage) {
            return with_stage(stage, [](auto settings) { return describe_rows(list_settings(settings)); });
        },
        "stage"_a, "Every setting of trace, relax, irradiance, render or loupe: name, kind, default, range …");
    module.def(
        "choose_k",
        [](const Photons* photons) { return choose_k(EstimateSettings{}, photons ? photons->emission : std::nullopt); },
        "photons"_a.none(), "How many photons an estimate gathers of a map where nothing is said.");
}

} // namespace photonloupe::bindings
