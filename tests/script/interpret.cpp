// SPDX-License-Identifier: Apache-2.0
#include "script/interpret.h"

#include <stdexcept>

#include "script/check/check_script.h"
#include "script/interpret/interpreter.h"

namespace photonloupe::script::tests {

HostPhotons make_photons(std::uint32_t count, std::uint32_t vertices) {
    HostPhotons photons;
    photons.count = count;
    photons.path_starts.push_back(0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i);
        photons.positions.insert(photons.positions.end(), {x, 10 * x, 100 * x});
        photons.normals.insert(photons.normals.end(), {0, 1, 0});
        photons.power.insert(photons.power.end(), {1, 2, 3});
        photons.emitters.push_back(static_cast<std::int32_t>(i % 2));
        for (std::uint32_t j = 0; j < vertices; ++j) {
            photons.path_vertices.insert(photons.path_vertices.end(), {x, static_cast<float>(j), 0});
            photons.path_normals.insert(photons.path_normals.end(), {0, 1, 0});
            photons.path_scatter.push_back(0.5f);
            photons.path_interactions.push_back(j == 0 || j + 1 == vertices ? 0 : 1);
            photons.path_objects.push_back(static_cast<std::int32_t>(j) - 1);
        }
        photons.path_starts.push_back(photons.path_starts.back() + vertices);
    }
    photons.find_neighbors = [count](NeighborQuery::Space, std::uint32_t photon, std::uint32_t k, float) {
        std::vector<std::int32_t> found; // the next ones by id
        for (std::uint32_t i = 1; i <= k && i < count; ++i)
            found.push_back(static_cast<std::int32_t>((photon + i) % count));
        return found;
    };
    return photons;
}

Ran interpret(const std::string& text, HostPhotons photons, const RunSettings& settings, const Progress& progress) {
    Ran ran;
    Diagnostics diagnostics;
    ran.program = check_script({"test.photon", text}, diagnostics);
    Plan plan;
    if (!diagnostics.has_errors())
        plan = plan_photon_loops(ran.program, diagnostics);
    if (diagnostics.has_errors()) {
        ran.errors = format_diagnostics(ran.program.source, diagnostics.sorted());
        return ran;
    }
    ran.outputs.columns = ScriptColumns(photons.count);
    Interpreter interpreter(ran.program, plan, photons, ran.outputs, settings, progress);
    interpreter.run();
    ran.state = interpreter.state();
    return ran;
}

std::uint32_t Ran::find(const std::string& name) const {
    if (!errors.empty())
        throw std::runtime_error(errors);
    for (std::uint32_t i = 0; i < program.variables.size(); ++i)
        if (program.variables[i].name == name)
            return i;
    throw std::runtime_error("there is no variable " + name);
}

float Ran::real(const std::string& name, std::size_t element) const {
    const std::uint32_t index = find(name);
    const Number value = state.variables[index].numbers.at(element);
    return program.variables[index].type == Type::integer ? static_cast<float>(value.integer) : value.real;
}

std::int32_t Ran::integer(const std::string& name, std::size_t element) const {
    const std::uint32_t index = find(name);
    if (program.variables[index].type != Type::integer)
        throw std::runtime_error(name + " is not an integer");
    return state.variables[index].numbers.at(element).integer;
}

bool Ran::is_set(const std::string& name) const {
    return state.variables[find(name)].is_set;
}

const FaultReport* Ran::find_fault(Fault kind) const {
    for (const FaultReport& fault : outputs.faults)
        if (fault.site.kind == kind)
            return &fault;
    return nullptr;
}

} // namespace photonloupe::script::tests
