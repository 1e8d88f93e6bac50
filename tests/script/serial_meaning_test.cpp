// SPDX-License-Identifier: Apache-2.0
// The meaning of a script is its serial meaning: loops that reduce in blocks and lanes give what one photon after
// another gives.
#include <sstream>

#include <gtest/gtest.h>

#include "script/check/check_script.h"
#include "script/interpret.h"
#include "script/interpret/interpreter.h"
#include "script/random_script.h"

namespace photonloupe::script::tests {
namespace {

struct Outcome {
    ScriptState state;
    RunOutputs outputs;
};

Outcome run(const Program& program, const Plan& plan, std::uint32_t photon_count) {
    HostPhotons photons = make_photons(photon_count);
    for (std::size_t i = 0; i < photons.positions.size(); ++i)
        photons.positions[i] = float(i % 17) - 3; // sums of small whole numbers are exact
    Outcome outcome;
    outcome.outputs.columns = ScriptColumns(photons.count);
    const RunSettings settings;
    const Progress quiet;
    Interpreter interpreter(program, plan, photons, outcome.outputs, settings, quiet);
    interpreter.run();
    outcome.state = interpreter.state();
    return outcome;
}

// Nothing is reduced: each variable goes from photon to photon.
Plan make_serial(Plan plan) {
    for (PhotonLoop& loop : plan.loops) {
        loop.variables.clear();
        loop.pca_2d = loop.pca_3d = loop.decomposition = AccumulatorUse::carried;
    }
    return plan;
}

std::string describe(const Program& program, Outcome& outcome) {
    std::string text;
    for (std::size_t i = 0; i < program.variables.size(); ++i) {
        if (program.variables[i].is_local || program.variables[i].type == Type::list)
            continue;
        text += program.variables[i].name + (outcome.state.variables[i].is_set ? "" : "?");
        for (const Number number : outcome.state.variables[i].numbers)
            text += ' ' + (program.variables[i].type == Type::integer ? std::to_string(number.integer)
                                                                      : std::to_string(number.real));
        text += '\n';
    }
    for (const float channel : outcome.outputs.columns.host_colors())
        text += std::to_string(channel) + ' ';
    for (const HistogramCounts& histogram : outcome.outputs.histograms) {
        text += '\n' + histogram.name + ' ' + std::to_string(histogram.below) + ' ' + std::to_string(histogram.above);
        for (const std::uint32_t count : histogram.counts)
            text += ' ' + std::to_string(count);
    }
    for (const FaultReport& fault : outcome.outputs.faults)
        text += '\n' + std::string(describe_fault(fault.site.kind)) + ' ' + std::to_string(fault.site.span.begin) +
                ' ' + std::to_string(fault.count) + ' ' + std::to_string(fault.first_photon);
    return text;
}

// The first line that differs; empty: none does.
std::string compare(const std::string& planned, const std::string& plain) {
    std::istringstream a(planned), b(plain);
    std::string line_a, line_b;
    while (std::getline(a, line_a) && std::getline(b, line_b))
        if (line_a != line_b)
            return "planned: " + line_a.substr(0, 200) + "\nplain:   " + line_b.substr(0, 200);
    return planned.size() == plain.size() ? "" : "one has more lines";
}

struct LoopCounts {
    std::uint32_t parallel = 0, serial = 0;
};

LoopCounts expect_same_meaning(std::uint32_t seed, std::uint32_t photon_count) {
    const std::string text = write_random_script(seed);
    Diagnostics diagnostics;
    const Program program = check_script({"random.photon", text}, diagnostics);
    const Plan plan = plan_photon_loops(program, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << format_diagnostics(program.source, diagnostics.sorted()) << text;
    if (diagnostics.has_errors())
        return {};
    LoopCounts counts;
    for (const PhotonLoop& loop : plan.loops)
        ++(loop.is_parallel ? counts.parallel : counts.serial);
    Outcome planned = run(program, plan, photon_count), plain = run(program, make_serial(plan), photon_count);
    EXPECT_EQ(compare(describe(program, planned), describe(program, plain)), "") << "seed " << seed << '\n' << text;
    return counts;
}

TEST(SerialMeaning, is_that_of_reductions_in_random_scripts) {
    LoopCounts all;
    for (std::uint32_t seed = 0; seed < 400 && !HasFailure(); ++seed) {
        const LoopCounts counts = expect_same_meaning(seed, 201);
        all.parallel += counts.parallel;
        all.serial += counts.serial;
    }
    EXPECT_GT(all.parallel, 200u); // the scripts are of both sorts
    EXPECT_GT(all.serial, 50u);
}

TEST(SerialMeaning, is_that_of_reductions_over_several_blocks) {
    for (std::uint32_t seed = 1000; seed < 1010 && !HasFailure(); ++seed)
        expect_same_meaning(seed, 9000);
}

} // namespace
} // namespace photonloupe::script::tests
