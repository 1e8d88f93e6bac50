// SPDX-License-Identifier: Apache-2.0
// Gives every name of a photon loop's body its role (docs/script.md, Loops over photons).
#include <algorithm>

#include "script/plan/plan_loop.h"

namespace photonloupe::script {
namespace {

bool has_one_role(const NameAccesses& name) {
    return name.reads.empty() && name.writes.empty() && !name.steps.empty() &&
           std::all_of(name.steps.begin(), name.steps.end(), [&](const NameAccesses::Step& step) {
               return step.role == name.steps[0].role && step.of == name.steps[0].of;
           });
}

std::set<std::uint32_t> list_payload(const ChoiceStatement& choice) {
    std::set<std::uint32_t> names;
    for (const Expression* assignment : choice.payload)
        names.insert(assignment->variable);
    return names;
}

// What is assigned with the winner may be used for nothing else: it tells the order of photons.
bool holds(const LoopFacts& facts, const ChoiceStatement& choice) {
    const auto& names = facts.accesses.names;
    if (facts.is_local(choice.decided) || !has_one_role(names.at(choice.decided)))
        return false;
    const std::set<std::uint32_t> payload = list_payload(choice);
    if (payload.size() != choice.payload.size())
        return false;
    for (std::uint32_t name : payload)
        if (!has_one_role(names.at(name)))
            return false;
    for (const auto& [statement, other] : facts.accesses.choices)
        if (other.decided == choice.decided && list_payload(other) != payload)
            return false;
    return true;
}

void find_choices(LoopFacts& facts) {
    std::set<const Statement*> ordinary;
    while (true) {
        facts.accesses = collect_accesses(facts.program, facts.statement, ordinary);
        const std::size_t before = ordinary.size();
        for (const auto& [statement, choice] : facts.accesses.choices)
            if (!holds(facts, choice))
                ordinary.insert(statement);
        if (ordinary.size() == before)
            return;
    }
}

VariableUse find_use(const LoopFacts& facts, std::uint32_t variable, const NameAccesses& name) {
    if (has_one_role(name) && (name.steps[0].role == Role::payload || !facts.is_local(variable)))
        return {name.steps[0].role, name.steps[0].of};
    if (name.writes.empty() && name.steps.empty())
        return {Role::uniform};
    return {facts.is_local(variable) ? Role::local : Role::carried};
}

AccumulatorUse find_accumulator_use(const LoopFacts& facts, std::uint32_t name) {
    const auto found = facts.accesses.names.find(name);
    if (found == facts.accesses.names.end())
        return AccumulatorUse::unused;
    const NameAccesses& accesses = found->second;
    if (accesses.writes.empty() && accesses.steps.empty())
        return AccumulatorUse::uniform;
    if (facts.is_local(name))
        return AccumulatorUse::local;
    return has_one_role(accesses) ? AccumulatorUse::reduction : AccumulatorUse::carried;
}

} // namespace

void classify_names(LoopFacts& facts, PhotonLoop& loop) {
    find_choices(facts);
    for (const auto& [statement, choice] : facts.accesses.choices)
        loop.choices[statement] = choice.decided;
    for (const auto& [name, accesses] : facts.accesses.names)
        if (name < facts.names.variable_count && name != facts.statement.variable)
            loop.variables[name] = find_use(facts, name, accesses);
    loop.variables[facts.statement.variable] = {Role::local};
    loop.pca_2d = find_accumulator_use(facts, facts.names.moments(2));
    loop.pca_3d = find_accumulator_use(facts, facts.names.moments(3));
    loop.decomposition = find_accumulator_use(facts, facts.names.decomposition());
}

} // namespace photonloupe::script
