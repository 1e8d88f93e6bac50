// SPDX-License-Identifier: Apache-2.0
// Decides which photon loops run as compute passes, and what each reads, writes and reduces (docs/script.md,
// Loops over photons).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "script/program.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// How a loop body uses a script variable.
enum class Role : std::uint8_t {
    local,   // definitely assigned before each use in an iteration, not read after the loop
    uniform, // not written in the body
    sum,     // s += e, s -= e, s++, s--, s = s + e
    minimum, // s = min(s, e): any NaN gives NaN, -0 < +0
    maximum,
    least, // if (e < s) { s = e; payload = …; }: NaN never wins, ties to the lowest photon id
    greatest,
    payload, // assigned together with a least or greatest; `of` is that variable
    carried, // anything else: the loop runs serially
};

struct VariableUse {
    Role role = Role::local;
    std::uint32_t of = 0; // payload: the least or greatest it goes with
};

// How a body uses an accumulator of moments (the 2-D and the 3-D one have their own; the decomposition they share).
enum class AccumulatorUse : std::uint8_t { unused, local, uniform, reduction, carried };

// One neighbour query of a pass; its rows are gathered before the pass runs.
struct NeighborQuery {
    enum class Space : std::uint8_t { world, parameter, constrained };
    const Expression* call = nullptr; // the builtin call
    Space space = Space::world;
    // k and β in terms that hold before the loop. Absent: the default k; no β.
    std::optional<Expression> count, beta;
    bool is_at_loop_photon = false; // then chunks suffice; else rows of all photons are needed
};

struct PhotonLoop {
    const Statement* statement = nullptr;
    bool is_parallel = true;
    std::vector<Diagnostic> reasons; // why it is serial: warnings that name the variable or call, and the rewrite
    std::map<std::uint32_t, VariableUse> variables; // every variable the body (functions too) uses
    // The if statements recognised as arg-min or arg-max, by their address, with the variable they decide.
    std::map<const Statement*, std::uint32_t> choices;
    AccumulatorUse pca_2d = AccumulatorUse::unused;
    AccumulatorUse pca_3d = AccumulatorUse::unused;
    AccumulatorUse decomposition = AccumulatorUse::unused;
    std::vector<NeighborQuery> queries;
    std::uint32_t columns = 0; // read; Columns
    // Functions' parameters that are never assigned, with what they are given: they count as that.
    std::map<std::uint32_t, const Expression*> given;
    // Variables that may be read while unset, in the body; reading them there is checked.
    std::set<std::uint32_t> unset_reads;
    bool sets_parameters = false, sets_colors = false, reads_own_parameters = false, prints = false;
    bool needs_fuel = false; // holds a loop that is not bounded
    bool has_reductions() const;
};

struct Plan {
    std::vector<PhotonLoop> loops; // in source order, each once
    const PhotonLoop* find(const Statement& statement) const;
};

constexpr std::int32_t DEFAULT_NEIGHBORS = 50;
constexpr std::uint32_t DEFAULT_BINS = 64; // of a histogram
constexpr std::uint32_t MOST_BINS = 4096;

// The expression, or what a never assigned parameter was given for it; conversions to float are looked through.
const Expression& resolve_given(const PhotonLoop& loop, const Expression& expression);
bool is_loop_photon(const PhotonLoop& loop, const Expression& expression);
// A number known when the script is compiled.
std::optional<double> find_constant(const Program& program, const PhotonLoop& loop, const Expression& expression);

// Errors of the parallel rules (parameters set and queried in one loop …) go to `diagnostics`.
Plan plan_photon_loops(const Program& program, Diagnostics& diagnostics);

} // namespace photonloupe::script
