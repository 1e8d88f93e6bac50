// SPDX-License-Identifier: Apache-2.0
// What a photon loop's calls need and do: neighbour queries, columns, photon columns set.
#include "script/builtins.h"
#include "script/plan/plan_loop.h"
#include "script/plan/substitute.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

void add_query(const LoopFacts& facts, PhotonLoop& loop, const Expression& call) {
    NeighborQuery query;
    query.call = &call;
    query.space = call.builtin->id == BuiltinId::get_knn             ? NeighborQuery::Space::world
                  : call.builtin->id == BuiltinId::get_parameter_knn ? NeighborQuery::Space::parameter
                                                                     : NeighborQuery::Space::constrained;
    query.is_at_loop_photon = is_loop_photon(loop, call.operands[0]);
    if (call.operands.size() > 1)
        query.count = substitute_given(facts.program, loop, call.operands[1]);
    if (call.operands.size() > 2)
        query.beta = substitute_given(facts.program, loop, call.operands[2]);
    loop.queries.push_back(std::move(query));
}

// Dimensions 0–2 are the position.
bool reads_position(const LoopFacts& facts, const PhotonLoop& loop, const Expression& call) {
    const std::optional<double> dimension = find_constant(facts.program, loop, call.operands[1]);
    return dimension && *dimension >= 0 && *dimension <= 2;
}

const Expression* find_call(const LoopFacts& facts, BuiltinId id) {
    for (const Expression* call : facts.accesses.calls)
        if (call->builtin->id == id)
            return call;
    return nullptr;
}

void refuse_query(const LoopFacts& facts, const NeighborQuery& query, Diagnostics& diagnostics) {
    const Expression& setter = *find_call(facts, BuiltinId::set_photon_parameter);
    diagnostics.add(codes::SETS_AND_QUERIES, query.call->span,
                    "'" + std::string(query.call->builtin->name) +
                        "' looks for neighbours in parameter space while the same loop sets parameters (line " +
                        std::to_string(facts.find_line(setter.span)) + ")",
                    "split the loop: set the parameters in one loop over photons, query them in the next");
}

std::string quote(const Expression& call) {
    return "'" + std::string(call.builtin->name) + "'";
}

} // namespace

void classify_calls(const LoopFacts& facts, PhotonLoop& loop, Diagnostics& diagnostics) {
    for (const Expression* call : facts.accesses.calls) {
        switch (call->builtin->id) {
        case BuiltinId::set_photon_parameter:
            loop.sets_parameters = true;
            break;
        case BuiltinId::set_photon_colour_encoding:
            loop.sets_colors = true;
            break;
        case BuiltinId::print:
            loop.prints = true;
            break;
        case BuiltinId::get_knn:
        case BuiltinId::get_parameter_knn:
        case BuiltinId::get_constrained_knn:
            add_query(facts, loop, *call);
            break;
        case BuiltinId::get_photon_parameter:
            if (reads_position(facts, loop, *call)) {
                loop.columns |= COLUMN_POSITION;
                continue;
            }
            loop.reads_own_parameters |= is_loop_photon(loop, call->operands[0]);
            if (!find_constant(facts.program, loop, call->operands[1]))
                loop.columns |= COLUMN_POSITION;
            loop.columns |= COLUMN_PARAMETERS;
            continue;
        default:
            break;
        }
        loop.columns |= call->builtin->columns;
    }
    if (loop.sets_parameters)
        for (const NeighborQuery& query : loop.queries)
            if (query.space != NeighborQuery::Space::world)
                refuse_query(facts, query, diagnostics);
}

void explain_calls(const LoopFacts& facts, PhotonLoop& loop) {
    const std::string photon = "'" + facts.program.variables[facts.statement.variable].name + "'";
    for (const Expression* call : facts.accesses.calls) {
        if (call->builtin->effect == Effect::sets_photon && !is_loop_photon(loop, call->operands[0]))
            loop.reasons.push_back({codes::OTHER_PHOTON, Severity::warning, call->operands[0].span,
                                    "the loop over photons runs serially: " + quote(*call) +
                                        " writes at another photon than the loop's own, " + photon,
                                    "write at " + photon + " only; what other photons give can be read there"});
        if (call->builtin->id == BuiltinId::get_photon_parameter && loop.sets_parameters &&
            !is_loop_photon(loop, call->operands[0]) && !reads_position(facts, loop, *call))
            loop.reasons.push_back({codes::OTHER_PHOTON, Severity::warning, call->operands[0].span,
                                    "the loop over photons runs serially: " + quote(*call) +
                                        " reads parameters of other photons, which the loop sets",
                                    "set the parameters in one loop over photons and read them in the next"});
    }
}

} // namespace photonloupe::script
