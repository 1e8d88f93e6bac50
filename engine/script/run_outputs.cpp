// SPDX-License-Identifier: Apache-2.0
// Collects what a script run gives.
#include "script/run_outputs.h"

#include <algorithm>
#include <cmath>

namespace photonloupe::script {

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

std::size_t RunOutputs::find_histogram(const std::string& name, float low, float high, std::uint32_t bins) {
    for (std::size_t i = 0; i < histograms.size(); ++i) {
        const HistogramCounts& known = histograms[i];
        if (known.name == name && known.low == low && known.high == high && known.counts.size() == bins)
            return i;
    }
    histograms.push_back({name, low, high, std::vector<std::uint32_t>(bins)});
    return histograms.size() - 1;
}

LoopReport& RunOutputs::find_loop(const Statement& loop) {
    for (LoopReport& report : loops)
        if (report.loop == &loop)
            return report;
    return loops.emplace_back(LoopReport{&loop});
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
