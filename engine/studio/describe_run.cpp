// SPDX-License-Identifier: Apache-2.0
// A line for each pass, fault and parameter that has something to be told.
#include "studio/stages.h"

namespace photonloupe::studio {
namespace {

std::string count_photons(std::uint32_t count) {
    return std::to_string(count) + " photons";
}

std::vector<std::string> list_lines(const script::ScriptRun& run, const script::Source& source) {
    std::vector<std::string> lines;
    const auto begin_line = [&](std::size_t place) {
        return "line " + std::to_string(source.find_place(place).line) + ": ";
    };
    for (const script::LoopReport& loop : run.loops)
        lines.push_back(begin_line(loop.loop.begin) + (loop.is_parallel ? "parallel" : "serial") + " loop" +
                        (loop.stopped.empty() ? "" : ", stopped: " + loop.stopped));
    for (const script::FaultReport& fault : run.faults)
        lines.push_back(
            begin_line(fault.site.span.begin) + script::describe_fault(fault.site.kind) + ", " +
            count_photons(fault.count) +
            (fault.first_photon == script::NO_PHOTON ? "" : " first at photon " + std::to_string(fault.first_photon)));
    for (const script::ParameterResult& parameter : run.parameters)
        for (const auto& [counted, what] : {std::pair(parameter.unset, " unset"),
                                            {parameter.out_of_bounds, " out of bounds"},
                                            {parameter.non_finite, " non finite"}})
            if (counted.count > 0)
                lines.push_back(parameter.declared.name + ": " + count_photons(counted.count) + what);
    if (!run.stopped.empty())
        lines.push_back("stopped: " + run.stopped);
    return lines;
}

} // namespace

ScriptResult describe_run(const script::ScriptRun& run, const script::Source& source) {
    ScriptResult result{{}, run.prints, list_lines(run, source), 0};
    for (const script::HistogramCounts& histogram : run.histograms)
        result.histograms.push_back(
            {histogram.name, histogram.low, histogram.high, {histogram.counts.begin(), histogram.counts.end()}});
    return result;
}

} // namespace photonloupe::studio
