// SPDX-License-Identifier: Apache-2.0
// Binds engine/script: a checked script with its diagnostics, and runs over photon maps.
#include "binding.h"

#include "core/hash.h"
#include "script/builtins.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::bindings {
namespace {

using script::CompiledScript;

struct BoundScript {
    std::unique_ptr<CompiledScript> compiled;
    std::string hash;
};

void make_script(BoundScript* self, nb::bytes text, const std::string& name) {
    std::string source(text.c_str(), text.size());
    std::string hash = hash_bytes(source);
    new (self) BoundScript{script::compile_script({name, std::move(source)}), std::move(hash)};
}

nb::list list_diagnostics(const BoundScript& self) {
    const script::Source& source = self.compiled->program.source;
    return list_rows(self.compiled->diagnostics, [&](const script::Diagnostic& diagnostic) {
        const script::Place start = source.find_place(diagnostic.span.begin);
        const script::Place end = source.find_place(diagnostic.span.end);
        std::string text = script::format_diagnostic(source, diagnostic);
        while (!text.empty() && text.back() == '\n')
            text.pop_back();
        return make_row("code"_a = diagnostic.code,
                        "severity"_a = diagnostic.severity == script::Severity::error ? "error" : "warning",
                        "message"_a = diagnostic.message, "note"_a = diagnostic.note, "line"_a = start.line,
                        "column"_a = start.column, "end_line"_a = end.line, "end_column"_a = end.column,
                        "text"_a = text);
    });
}

nb::list list_exposed(const BoundScript& self) {
    return list_rows(self.compiled->program.exposed, [&](const std::uint32_t index) {
        const script::Variable& variable = self.compiled->program.variables[index];
        return make_row("name"_a = variable.name, "low"_a = variable.exposed->low, "high"_a = variable.exposed->high,
                        "step"_a = variable.exposed->step, "integer"_a = variable.exposed->is_integer,
                        "default"_a = variable.default_value);
    });
}

const char* name_role(script::Role role) {
    switch (role) {
    case script::Role::sum:
        return "sum";
    case script::Role::minimum:
        return "minimum";
    case script::Role::maximum:
        return "maximum";
    case script::Role::least:
        return "arg-min";
    case script::Role::greatest:
        return "arg-max";
    case script::Role::payload:
        return "of an arg-min or arg-max";
    default:
        return "";
    }
}

const char* name_space(script::NeighborQuery::Space space) {
    return space == script::NeighborQuery::Space::world       ? "world"
           : space == script::NeighborQuery::Space::parameter ? "parameter"
                                                              : "constrained";
}

nb::list list_passes(const BoundScript& self) {
    const script::Program& program = self.compiled->program;
    return list_rows(self.compiled->plan.loops, [&](const script::PhotonLoop& loop) {
        nb::dict reductions;
        for (const auto& [variable, use] : loop.variables)
            if (*name_role(use.role))
                reductions[nb::str(program.variables[variable].name.c_str())] = name_role(use.role);
        return make_row("line"_a = program.source.find_place(loop.statement->span.begin).line,
                        "kind"_a = loop.is_parallel ? "parallel" : "serial",
                        "reasons"_a = list_rows(loop.reasons, [](const auto& reason) { return reason.message; }),
                        "reductions"_a = reductions, "queries"_a = list_rows(loop.queries, [](const auto& query) {
                                                         return name_space(query.space);
                                                     }));
    });
}

nb::list list_glsl(const BoundScript& self) {
    nb::list texts;
    for (std::size_t i = 0; i < self.compiled->passes.size(); ++i)
        if (self.compiled->plan.loops[i].is_parallel)
            texts.append(self.compiled->passes[i].glsl);
    return texts;
}

nb::list list_spirv(const BoundScript& self) {
    nb::list passes;
    for (std::size_t i = 0; i < self.compiled->passes.size(); ++i) {
        if (!self.compiled->plan.loops[i].is_parallel)
            continue;
        const std::vector<std::uint32_t> words = gpu::compile_generated(script::name_kernel(self.compiled->passes[i]));
        passes.append(nb::bytes(reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]));
    }
    return passes;
}

script::RunSettings read_settings(const nb::dict& given) {
    script::RunSettings settings;
    settings.values = nb::cast<std::map<std::string, double>>(given["values"]);
    settings.seed = nb::cast<std::uint32_t>(given["seed"]);
    settings.fuel = nb::cast<std::uint32_t>(given["fuel"]);
    settings.most_exhausted = nb::cast<std::uint32_t>(given["exhausted"]);
    settings.most_seconds = nb::cast<double>(given["seconds"]);
    return settings;
}

nb::object photon_or_none(std::uint32_t photon) {
    return photon == script::NO_PHOTON ? nb::none() : nb::cast(photon);
}

nb::dict describe_count(const script::ValueCount& counted) {
    return make_row("count"_a = counted.count, "first_photon"_a = photon_or_none(counted.first_photon));
}

nb::dict describe_report(const BoundScript& self, const script::ScriptRun& run) {
    const script::Source& source = self.compiled->program.source;
    const nb::list passes = list_rows(run.loops, [&](const script::LoopReport& loop) {
        return make_row("line"_a = source.find_place(loop.loop.begin).line,
                        "kind"_a = loop.is_parallel ? "parallel" : "serial", "runs"_a = loop.runs,
                        "milliseconds"_a = loop.milliseconds, "exhausted"_a = loop.exhausted,
                        "first_exhausted"_a = photon_or_none(loop.first_exhausted),
                        "exhausted_line"_a =
                            loop.exhausted ? nb::cast(source.find_place(loop.exhausted_at.begin).line) : nb::none(),
                        "stopped"_a = loop.stopped);
    });
    const nb::list faults = list_rows(run.faults, [&](const script::FaultReport& fault) {
        const script::Place place = source.find_place(fault.site.span.begin);
        return make_row("line"_a = place.line, "column"_a = place.column,
                        "what"_a = script::describe_fault(fault.site.kind),
                        "first_photon"_a = photon_or_none(fault.first_photon), "count"_a = fault.count);
    });
    nb::dict parameters;
    for (const script::ParameterResult& parameter : run.parameters) {
        parameters[nb::str(parameter.declared.name.c_str())] =
            make_row("line"_a = parameter.line, "unset"_a = describe_count(parameter.unset),
                     "out_of_bounds"_a = describe_count(parameter.out_of_bounds),
                     "non_finite"_a = describe_count(parameter.non_finite));
    }
    return make_row("passes"_a = passes, "faults"_a = faults, "parameters"_a = parameters,
                    "columns"_a = script::list_columns(self.compiled->program), "stopped"_a = run.stopped);
}

nb::dict describe_run(const BoundScript& self, const script::ScriptRun& run) {
    const nb::list histograms = list_rows(run.histograms, [](const script::HistogramCounts& histogram) {
        return make_row("name"_a = histogram.name, "low"_a = histogram.low, "high"_a = histogram.high,
                        "counts"_a = own_array(std::vector<std::uint32_t>(histogram.counts)),
                        "below"_a = histogram.below, "above"_a = histogram.above,
                        "non_finite"_a = histogram.non_finite);
    });
    return make_row("report"_a = describe_report(self, run), "histograms"_a = histograms, "prints"_a = run.prints,
                    "exposed"_a = run.exposed);
}

nb::dict run(BoundScript& self, OpenDevice& open, Photons& photons, const nb::dict& given, nb::object progress) {
    const script::RunSettings settings = read_settings(given);
    const bool keeps = nb::cast<bool>(given["keep"]);
    const auto run = PythonProgress(std::move(progress)).run([&](const Progress& asked) {
        return open.workbench.run_script(photons, *self.compiled, settings, keeps, asked);
    });
    return describe_run(self, *run);
}

nb::list list_builtins() {
    return list_rows(script::list_builtins(), [](const script::Builtin& builtin) {
        return make_row("name"_a = builtin.name, "signature"_a = builtin.signature, "group"_a = builtin.group,
                        "doc"_a = builtin.doc);
    });
}

nb::list list_codes() {
    return list_rows(script::list_diagnostic_codes(), [](const script::DiagnosticCode& code) {
        return make_row("code"_a = code.code, "meaning"_a = code.meaning);
    });
}

} // namespace

void bind_script(nb::module_& module) {
    nb::class_<BoundScript>(module, "Script")
        .def("__init__", &make_script, "text"_a, "name"_a)
        .def_prop_ro("hash", [](const BoundScript& self) { return self.hash; })
        .def_prop_ro("diagnostics", &list_diagnostics)
        .def_prop_ro("exposed", &list_exposed)
        .def_prop_ro("columns", [](const BoundScript& self) { return script::list_columns(self.compiled->program); })
        .def_prop_ro("passes", &list_passes)
        .def("glsl", &list_glsl, "The text of every compute pass.")
        .def("spirv", &list_spirv, "Every compute pass as SPIR-V.")
        .def("run", &run, "device"_a, "photons"_a, "settings"_a, "progress"_a = nb::none(),
             "Run over a map; settings: values, keep, seed, fuel, exhausted, seconds.");
    module.def("list_script_builtins", &list_builtins, "Every predefined call: name, signature, group, doc.");
    module.def("list_script_codes", &list_codes, "Every diagnostic code with its meaning.");
}

} // namespace photonloupe::bindings
