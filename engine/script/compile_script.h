// SPDX-License-Identifier: Apache-2.0
// Source → tokens → syntax tree → checked tree → plan → GLSL, and everything that is wrong with the source.
#pragma once

#include <memory>
#include <vector>

#include "script/emit/emit.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

struct CompiledScript {
    Program program;
    Plan plan;                           // points into the program
    std::vector<EmittedPass> passes;     // of plan.loops; those of serial loops are empty
    std::vector<Diagnostic> diagnostics; // in source order; with an error among them there is no plan
    bool has_errors = false;
};

// Never throws for what a source may hold.
std::unique_ptr<CompiledScript> compile_script(const Source& source);

// Throws ScriptError when it has errors.
void require_script(const CompiledScript& script);

} // namespace photonloupe::script
