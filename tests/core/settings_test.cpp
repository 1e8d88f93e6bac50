// SPDX-License-Identifier: Apache-2.0
// Settings by their rows: what they may hold, how they are written, and what is automatic.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/setting_json.h"
#include "estimate/settings.h"
#include "inspect/settings.h"
#include "relax/settings.h"

namespace photonloupe::test {
namespace {

// A value that the setting does not hold yet.
SettingValue choose_other(const Setting& setting) {
    switch (setting.kind) {
    case SettingKind::flag:
        return !std::get<bool>(setting.read(setting));
    case SettingKind::choice:
        return setting.about.choices[setting.read(setting) == SettingValue(setting.about.choices[0]) ? 1 : 0];
    case SettingKind::numbers: {
        std::vector<double> numbers;
        for (std::size_t i = 0; i < setting.width; ++i)
            numbers.push_back(0.5 + static_cast<double>(i));
        return numbers;
    }
    default:
        return setting.about.range.high;
    }
}

template <class Settings>
class SettingsOfStage : public ::testing::Test {};

using Stages = ::testing::Types<TraceSettings, RelaxSettings, EstimateSettings, RenderSettings, inspect::LoupeSettings>;
TYPED_TEST_SUITE(SettingsOfStage, Stages);

TYPED_TEST(SettingsOfStage, defaults_may_be) {
    EXPECT_NO_THROW(require_settings("stage", TypeParam{}));
}

TYPED_TEST(SettingsOfStage, every_change_changes_the_key_and_is_read_as_written) {
    TypeParam defaults;
    const std::string key = write_key(list_settings(defaults));
    for (std::size_t i = 0; i < list_settings(defaults).size(); ++i) {
        TypeParam changed, again;
        const Setting setting = list_settings(changed)[i];
        write_setting(setting, choose_other(setting));
        EXPECT_FALSE(changed == defaults) << setting.about.name;
        EXPECT_NE(write_key(list_settings(changed)), key) << setting.about.name;
        EXPECT_EQ(read_json(list_settings(again)[i], write_json(setting)), "") << setting.about.name;
        EXPECT_TRUE(again == changed) << setting.about.name;
    }
}

TYPED_TEST(SettingsOfStage, nothing_is_held_by_its_name_alone) {
    TypeParam settings;
    for (const Setting& setting : list_settings(settings)) {
        EXPECT_EQ(find_fault(setting, {}).empty(), !setting.about.empty.empty()) << setting.about.name;
        if (setting.about.empty.empty())
            continue;
        write_setting(setting, setting.about.empty);
        EXPECT_EQ(setting.read(setting), SettingValue{}) << setting.about.name;
        EXPECT_EQ(write_json(setting), setting.about.empty) << setting.about.name;
    }
}

TYPED_TEST(SettingsOfStage, what_lies_beyond_the_range_is_refused_and_changes_nothing) {
    TypeParam settings;
    for (const Setting& setting : list_settings(settings)) {
        if (setting.kind != SettingKind::count && setting.kind != SettingKind::number)
            continue;
        for (const double beyond : {setting.about.range.low - 1.0, 2.0 * setting.about.range.high + 1.0})
            EXPECT_THROW(write_setting(setting, beyond), Error) << setting.about.name;
    }
    EXPECT_TRUE(settings == TypeParam{});
}

TEST(Settings, refusals_name_the_setting_and_what_it_may_be) {
    const auto refuse = [](const char* name, const SettingValue& value) -> std::string {
        RelaxSettings settings;
        try {
            write_setting(find_setting(list_settings(settings), name), value);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refuse("neighbors", 999.0), "neighbors must be from 1 to 998, not 999");
    EXPECT_EQ(refuse("neighbors", 1.5), "neighbors must be from 1 to 998, a whole number, not 1.5");
    EXPECT_EQ(refuse("search", "exakt"), "search must be one of exact, carried, not \"exakt\"");
    EXPECT_EQ(refuse("thresholds", std::vector{1.0, 1.0}), "thresholds must be two different numbers, not both 1");
    EXPECT_EQ(refuse("period", std::vector{1.0}), "period must be 3 numbers");
    EXPECT_EQ(refuse("diffuse_flux", 1.0), "diffuse_flux must be true or false");
    EXPECT_EQ(refuse("over_relaxation", 1.5), "");
}

TEST(Settings, complete_ones_hold_something_everywhere) {
    RelaxSettings settings;
    settings.descriptor = Descriptor::split;
    RelaxSettings complete = complete_settings(settings, Emission::sobol, true);
    for (const Setting& setting : list_settings(complete))
        EXPECT_NE(setting.read(setting), SettingValue{}) << setting.about.name;
    EXPECT_EQ(complete.steps, choose_steps(Emission::sobol));
    EXPECT_EQ(complete.constraint, Space::parameter);
    EXPECT_EQ(complete.constraint_neighbors, choose_constraint_neighbors(Descriptor::split));
    EXPECT_LT(*complete.steps, *complete_settings(settings, std::nullopt, false).steps);
}

TEST(Settings, thresholds_of_pca_grow_with_k_and_keep_their_span) {
    double before = 0;
    for (const std::uint32_t k : {12u, 20u, 50u, 75u, 100u, 250u, 998u}) {
        const auto [free_at, fixed_at] = choose_thresholds(Descriptor::pca, k);
        EXPECT_GT(free_at, before) << k;
        EXPECT_NEAR(free_at - fixed_at, 0.3, 1e-12) << k;
        before = free_at;
    }
    EXPECT_NEAR(choose_thresholds(Descriptor::pca, 50)[0], 0.75 + 0.05, 1e-12); // METHODS §5.2
}

} // namespace
} // namespace photonloupe::test
