// SPDX-License-Identifier: Apache-2.0
// Says why a name makes a loop over photons serial, and how to rewrite it.
#include <algorithm>

#include "script/plan/plan_loop.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

const std::string SERIAL = "the loop over photons runs serially: ";

const char* describe_role(Role role) {
    switch (role) {
    case Role::sum:
        return "summed";
    case Role::minimum:
    case Role::least:
        return "minimized";
    case Role::maximum:
    case Role::greatest:
        return "maximized";
    default:
        return "assigned with a least or greatest value";
    }
}

std::uint32_t find_end(const std::vector<Statement>& body) {
    std::uint32_t end = 0;
    visit_expressions(body, [&](const Expression& e) { end = std::max(end, e.span.end); });
    return end;
}

// " (line 12)" where the name is read next after the loop, if that can be said.
std::string find_later_read(const LoopFacts& facts, std::uint32_t variable) {
    const std::uint32_t end = find_end(facts.statement.body);
    std::uint32_t best = 0;
    visit_expressions(facts.program.body, [&](const Expression& e) {
        const bool reads = e.kind == Expression::Kind::variable || e.kind == Expression::Kind::element;
        if (reads && e.variable == variable && e.span.begin > end && (best == 0 || e.span.begin < best))
            best = e.span.begin;
    });
    return best == 0 ? "" : " (line " + std::to_string(facts.find_line({best, best})) + ")";
}

Diagnostic explain_mixture(const std::string& name, const NameAccesses& uses, const NameAccesses::Step& other) {
    return {codes::REDUCED_AND_USED, Severity::warning, other.span,
            SERIAL + name + " is both " + describe_role(uses.steps[0].role) + " and " + describe_role(other.role),
            "use one variable for each"};
}

Diagnostic explain_step(const LoopFacts& facts, const std::string& name, const NameAccesses& uses) {
    const NameAccesses::Step& first = uses.steps[0];
    for (const NameAccesses::Step& step : uses.steps)
        if (step.role != first.role || step.of != first.of)
            return explain_mixture(name, uses, step);
    const bool is_read = !uses.reads.empty();
    return {codes::REDUCED_AND_USED, Severity::warning, is_read ? uses.reads[0] : uses.writes[0],
            SERIAL + name + " is " + describe_role(first.role) + " over photons (line " +
                std::to_string(facts.find_line(first.span)) + ") and also " + (is_read ? "read" : "assigned") +
                " in the loop",
            is_read ? "read it after the loop; a value for each photon needs a variable of its own"
                    : "assign it before the loop"};
}

Diagnostic explain_array(const std::string& name, const NameAccesses& uses) {
    return {codes::KEEPS_VALUE, Severity::warning, uses.writes[0],
            SERIAL + "elements of " + name + " keep values from one photon to the next",
            "declare the array inside the loop, or reduce into it: 'a[k] += e', 'a[k] = min(a[k], e)', "
            "'if (e < a[k]) a[k] = e'"};
}

Diagnostic explain_scalar(const LoopFacts& facts, std::uint32_t variable, const std::string& name,
                          const NameAccesses& uses) {
    if (facts.enters[variable])
        return {codes::KEEPS_VALUE, Severity::warning, uses.reads.empty() ? uses.writes[0] : uses.reads[0],
                SERIAL + name + " may keep its value from one photon to the next",
                "assign it in every iteration before it is read, or reduce into it: 's += e', 's = min(s, e)', "
                "'if (e < s) { s = e; j = i; }'"};
    return {codes::KEEPS_VALUE, Severity::warning, uses.writes[0],
            SERIAL + name + " is read after the loop" + find_later_read(facts, variable) +
                ", where it holds the last photon's value",
            "reduce into it ('s += e', 's = min(s, e)'), or use another variable after the loop"};
}

void explain_accumulator(const LoopFacts& facts, PhotonLoop& loop, AccumulatorUse use, std::uint32_t name,
                         const std::string& text) {
    if (use != AccumulatorUse::carried)
        return;
    const NameAccesses& uses = facts.accesses.names.at(name);
    const Span span = !uses.reads.empty() ? uses.reads[0] : !uses.steps.empty() ? uses.steps[0].span : uses.writes[0];
    const bool is_decomposition = name == facts.names.decomposition();
    loop.reasons.push_back({codes::KEEPS_POINTS, Severity::warning, span,
                            SERIAL + text +
                                (facts.enters[name] ? " keeps points from one photon to the next"
                                                    : " of the last photon is read after the loop"),
                            is_decomposition ? "decompose in every iteration before reading it"
                            : facts.enters[name]
                                ? "reset it in every iteration before the first push, or decompose it after the loop"
                                : "push without a reset to gather points of all photons"});
}

} // namespace

void explain_names(const LoopFacts& facts, PhotonLoop& loop) {
    const std::uint32_t photon = facts.statement.variable;
    if (const auto found = facts.accesses.names.find(photon); found != facts.accesses.names.end()) {
        const NameAccesses& uses = found->second;
        if (!uses.writes.empty() || !uses.steps.empty())
            loop.reasons.push_back(
                {codes::LEAVES_LOOP, Severity::warning, uses.writes.empty() ? uses.steps[0].span : uses.writes[0],
                 SERIAL + ("its variable '" + facts.program.variables[photon].name) + "' is assigned in it",
                 "use another variable; 'continue' goes on to the next photon"});
    }
    for (const Span span : facts.accesses.leaves)
        loop.reasons.push_back({codes::LEAVES_LOOP, Severity::warning, span, SERIAL + "this ends it early",
                                "use 'continue' to leave out a photon"});
    for (const auto& [variable, use] : loop.variables) {
        if (use.role != Role::carried)
            continue;
        const NameAccesses& uses = facts.accesses.names.at(variable);
        const Variable& declared = facts.program.variables[variable];
        const std::string name = "'" + declared.name + "'";
        loop.reasons.push_back(!uses.steps.empty()       ? explain_step(facts, name, uses)
                               : declared.array_size > 0 ? explain_array(name, uses)
                                                         : explain_scalar(facts, variable, name, uses));
    }
    explain_accumulator(facts, loop, loop.pca_2d, facts.names.moments(2), "the PCA of the plane");
    explain_accumulator(facts, loop, loop.pca_3d, facts.names.moments(3), "the PCA of space");
    explain_accumulator(facts, loop, loop.decomposition, facts.names.decomposition(), "the decomposition");
}

} // namespace photonloupe::script
