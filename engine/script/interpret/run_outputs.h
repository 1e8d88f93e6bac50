// SPDX-License-Identifier: Apache-2.0
// What a script run gives: parameters, colors, histograms, prints, and the report of what it met.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "script/interpret/script_columns.h"
#include "script/plan/fault_sites.h"
#include "script/program.h"

namespace photonloupe::script {

constexpr std::uint32_t PRINT_LIMIT = 20;           // lines of a photon loop
constexpr std::size_t UNIFORM_PRINT_LIMIT = 10'000; // lines of uniform code
constexpr std::size_t HISTOGRAM_LIMIT = 256;        // of other names, bounds or bins: a loop may compute them
constexpr std::uint32_t NO_PHOTON = 0xffffffffu;

struct HistogramCounts {
    std::string name;
    float low = 0, high = 0;
    std::vector<std::uint32_t> counts;
    std::uint32_t below = 0, above = 0, non_finite = 0;
    void add(float value);
};

// As a report says it.
const char* describe_fault(Fault kind);

struct FaultReport {
    FaultSite site;
    std::uint32_t first_photon = NO_PHOTON; // NO_PHOTON: in uniform code
    std::uint32_t count = 0;                // photons that met it; 1 in uniform code
};

// A photon loop, all its runs together.
struct LoopReport {
    Span loop; // of its statement
    bool is_parallel = false;
    std::uint32_t runs = 0;
    double milliseconds = 0;
    std::uint32_t exhausted = 0; // photons that ran out of fuel
    std::uint32_t first_exhausted = NO_PHOTON;
    Span exhausted_at;
    std::string stopped; // why it ended early; empty: it did not
};

struct RunOutputs {
    ScriptColumns columns;
    std::vector<HistogramCounts> histograms; // in the order first met
    std::vector<std::string> prints;
    std::vector<FaultReport> faults;
    std::vector<LoopReport> loops; // in the order first run
    std::string stopped;           // why the script ended early; empty: it did not

    // Its place among the histograms, if it is there.
    std::optional<std::size_t> seek_histogram(const std::string& name, float low, float high, std::uint32_t bins) const;
    // Its place among the histograms, where it is put if it is not there.
    std::size_t find_histogram(const std::string& name, float low, float high, std::uint32_t bins);
    LoopReport& find_loop(const Statement& loop);
    // A photon counts once for each site it meets: `photon` must not be lower than at the call before for that site.
    void add_fault(const FaultSite& site, std::uint32_t photon);
    void add_faults(const FaultSite& site, std::uint32_t first_photon, std::uint32_t count);

private:
    std::map<std::pair<std::uint64_t, Fault>, std::size_t> m_fault_places;
    std::map<std::size_t, std::uint32_t> m_last_photon;
    FaultReport& find_fault(const FaultSite& site);
};

} // namespace photonloupe::script
