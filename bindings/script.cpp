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
    nb::list rows;
    for (const script::Diagnostic& diagnostic : self.compiled->diagnostics) {
        const script::Place start = source.find_place(diagnostic.span.begin);
        const script::Place end = source.find_place(diagnostic.span.end);
        nb::dict row;
        row["code"] = diagnostic.code;
        row["severity"] = diagnostic.severity == script::Severity::error ? "error" : "warning";
        row["message"] = diagnostic.message;
        row["note"] = diagnostic.note;
        row["line"] = start.line;
        row["column"] = start.column;
        row["end_line"] = end.line;
        row["end_column"] = end.column;
        std::string text = script::format_diagnostic(source, diagnostic);
        while (!text.empty() && text.back() == '\n')
            text.pop_back();
        row["text"] = text;
        rows.append(row);
    }
    return rows;
}

nb::list list_exposed(const BoundScript& self) {
    nb::list rows;
    for (const std::uint32_t index : self.compiled->program.exposed) {
        const script::Variable& variable = self.compiled->program.variables[index];
        nb::dict row;
        row["name"] = variable.name;
        row["low"] = variable.exposed->low;
        row["high"] = variable.exposed->high;
        row["step"] = variable.exposed->step;
        row["integer"] = variable.exposed->is_integer;
        row["default"] = variable.default_value;
        rows.append(row);
    }
    return rows;
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
    nb::list rows;
    for (const script::PhotonLoop& loop : self.compiled->plan.loops) {
        nb::dict row, reductions;
        nb::list reasons, queries;
        for (const script::Diagnostic& reason : loop.reasons)
            reasons.append(reason.message);
        for (const auto& [variable, use] : loop.variables)
            if (*name_role(use.role))
                reductions[nb::str(program.variables[variable].name.c_str())] = name_role(use.role);
        for (const script::NeighborQuery& query : loop.queries)
            queries.append(name_space(query.space));
        row["line"] = program.source.find_place(loop.statement->span.begin).line;
        row["kind"] = loop.is_parallel ? "parallel" : "serial";
        row["reasons"] = reasons;
        row["reductions"] = reductions;
        row["queries"] = queries;
        rows.append(row);
    }
    return rows;
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
    nb::dict row;
    row["count"] = counted.count;
    row["first_photon"] = photon_or_none(counted.first_photon);
    return row;
}

nb::dict describe_report(const BoundScript& self, const script::ScriptRun& run) {
    const script::Source& source = self.compiled->program.source;
    nb::list passes, faults;
    for (const script::LoopReport& loop : run.loops) {
        nb::dict row;
        row["line"] = source.find_place(loop.loop.begin).line;
        row["kind"] = loop.is_parallel ? "parallel" : "serial";
        row["runs"] = loop.runs;
        row["milliseconds"] = loop.milliseconds;
        row["exhausted"] = loop.exhausted;
        row["first_exhausted"] = photon_or_none(loop.first_exhausted);
        row["exhausted_line"] = loop.exhausted ? nb::cast(source.find_place(loop.exhausted_at.begin).line) : nb::none();
        row["stopped"] = loop.stopped;
        passes.append(row);
    }
    for (const script::FaultReport& fault : run.faults) {
        const script::Place place = source.find_place(fault.site.span.begin);
        nb::dict row;
        row["line"] = place.line;
        row["column"] = place.column;
        row["what"] = script::describe_fault(fault.site.kind);
        row["first_photon"] = photon_or_none(fault.first_photon);
        row["count"] = fault.count;
        faults.append(row);
    }
    nb::dict parameters;
    for (const script::ParameterResult& parameter : run.parameters) {
        nb::dict row;
        row["line"] = parameter.line;
        row["unset"] = describe_count(parameter.unset);
        row["out_of_bounds"] = describe_count(parameter.out_of_bounds);
        row["non_finite"] = describe_count(parameter.non_finite);
        parameters[nb::str(parameter.declared.name.c_str())] = row;
    }
    nb::dict report;
    report["passes"] = passes;
    report["faults"] = faults;
    report["parameters"] = parameters;
    report["columns"] = script::list_columns(self.compiled->program);
    report["stopped"] = run.stopped;
    return report;
}

nb::dict describe_run(const BoundScript& self, const script::ScriptRun& run) {
    nb::dict result;
    result["report"] = describe_report(self, run);
    nb::list histograms;
    for (const script::HistogramCounts& histogram : run.histograms) {
        nb::dict row;
        row["name"] = histogram.name;
        row["low"] = histogram.low;
        row["high"] = histogram.high;
        row["counts"] = own_array(std::vector<std::uint32_t>(histogram.counts));
        row["below"] = histogram.below;
        row["above"] = histogram.above;
        row["non_finite"] = histogram.non_finite;
        histograms.append(row);
    }
    result["histograms"] = histograms;
    result["prints"] = run.prints;
    result["exposed"] = run.exposed;
    return result;
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
    nb::list rows;
    for (const script::Builtin& builtin : script::list_builtins()) {
        nb::dict row;
        row["name"] = std::string(builtin.name);
        row["signature"] = std::string(builtin.signature);
        row["group"] = std::string(builtin.group);
        row["doc"] = std::string(builtin.doc);
        rows.append(row);
    }
    return rows;
}

nb::list list_codes() {
    nb::list rows;
    for (const script::DiagnosticCode& code : script::list_diagnostic_codes()) {
        nb::dict row;
        row["code"] = std::string(code.code);
        row["meaning"] = std::string(code.meaning);
        rows.append(row);
    }
    return rows;
}

} // namespace

void bind_script(nb::module_& module) {
    nb::class_<BoundScript>(module, "Script")
        .def("__init__", &make_script, nb::arg("text"), nb::arg("name"))
        .def_prop_ro("hash", [](const BoundScript& self) { return self.hash; })
        .def_prop_ro("diagnostics", &list_diagnostics)
        .def_prop_ro("exposed", &list_exposed)
        .def_prop_ro("columns", [](const BoundScript& self) { return script::list_columns(self.compiled->program); })
        .def_prop_ro("passes", &list_passes)
        .def("glsl", &list_glsl, "The text of every compute pass.")
        .def("spirv", &list_spirv, "Every compute pass as SPIR-V.")
        .def("run", &run, nb::arg("device"), nb::arg("photons"), nb::arg("settings"),
             nb::arg("progress").none() = nb::none(),
             "Run over a map; settings: values, keep, seed, fuel, exhausted, seconds.");
    module.def("list_script_builtins", &list_builtins, "Every predefined call: name, signature, group, doc.");
    module.def("list_script_codes", &list_codes, "Every diagnostic code with its meaning.");
}

} // namespace photonloupe::bindings
