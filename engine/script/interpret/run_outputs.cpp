// SPDX-License-Identifier: Apache-2.0
// Collects what a script run gives.
#include "script/interpret/run_outputs.h"

#include <algorithm>
#include <cmath>

namespace photonloupe::script {

const char* describe_fault(Fault kind) {
    switch (kind) {
    case Fault::unset_variable:
        return "a variable is read before it is set";
    case Fault::array_index:
        return "an index is outside the array";
    case Fault::list_index:
        return "an index is outside the neighbor list";
    case Fault::photon_index:
        return "there is no such photon";
    case Fault::vertex_index:
        return "the photon's path has no such vertex";
    case Fault::axis_index:
        return "an axis or channel is not 0, 1 or 2";
    case Fault::dimension_index:
        return "the parameter is not declared, or is a coordinate, which cannot be set";
    case Fault::eigen_index:
        return "there is no such principal component; was decomposePCA called?";
    case Fault::not_integral:
        return "an index, axis, photon or dimension is not a whole number";
    case Fault::modulo_by_zero:
        return "a remainder by 0 is taken as 0";
    case Fault::does_not_fit:
        return "a number does not fit an integer";
    case Fault::no_value:
        return "a function ended without returning a value";
    case Fault::declaration:
        return "a parameter is declared with a gap before its dimension, or with bounds that do not ascend";
    case Fault::query:
        return "k is none that a query takes, or beta is negative";
    default:
        return "a histogram's bounds do not ascend, its bins are not 1 to 4,096, or there are more than 256 histograms";
    }
}

void HistogramCounts::add(float value) {
    if (!std::isfinite(value)) {
        ++non_finite;
    } else if (value < low) {
        ++below;
    } else if (value > high) {
        ++above;
    } else {
        const float place = (value - low) / (high - low) * static_cast<float>(counts.size());
        ++counts[std::min(static_cast<std::size_t>(place), counts.size() - 1)];
    }
}

std::optional<std::size_t> RunOutputs::seek_histogram(const std::string& name, float low, float high,
                                                      std::uint32_t bins) const {
    for (std::size_t i = 0; i < histograms.size(); ++i) {
        const HistogramCounts& known = histograms[i];
        if (known.name == name && known.low == low && known.high == high && known.counts.size() == bins)
            return i;
    }
    return std::nullopt;
}

std::size_t RunOutputs::find_histogram(const std::string& name, float low, float high, std::uint32_t bins) {
    if (const std::optional<std::size_t> known = seek_histogram(name, low, high, bins))
        return *known;
    histograms.push_back({name, low, high, std::vector<std::uint32_t>(bins)});
    return histograms.size() - 1;
}

LoopReport& RunOutputs::find_loop(const Statement& loop) {
    for (LoopReport& report : loops)
        if (report.loop.begin == loop.span.begin && report.loop.end == loop.span.end)
            return report;
    return loops.emplace_back(LoopReport{loop.span});
}

FaultReport& RunOutputs::find_fault(const FaultSite& site) {
    const std::uint64_t place = std::uint64_t{site.span.begin} << 32 | site.span.end;
    const auto [found, is_new] = m_fault_places.try_emplace({place, site.kind}, faults.size());
    if (is_new)
        faults.push_back({site, NO_PHOTON, 0});
    return faults[found->second];
}

void RunOutputs::add_fault(const FaultSite& site, std::uint32_t photon) {
    FaultReport& report = find_fault(site);
    const std::size_t place = static_cast<std::size_t>(&report - faults.data());
    const auto [last, is_new] = m_last_photon.try_emplace(place, photon);
    if (!is_new && last->second == photon)
        return;
    last->second = photon;
    ++report.count;
    report.first_photon = std::min(report.first_photon, photon);
}

void RunOutputs::add_faults(const FaultSite& site, std::uint32_t first_photon, std::uint32_t count) {
    if (count == 0)
        return;
    FaultReport& report = find_fault(site);
    report.first_photon = std::min(report.first_photon, first_photon);
    report.count += count;
}

} // namespace photonloupe::script
