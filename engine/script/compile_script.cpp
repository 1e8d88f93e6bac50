// SPDX-License-Identifier: Apache-2.0
// The language's stages in the order they run.
#include "script/compile_script.h"

#include "script/check/check_script.h"

namespace photonloupe::script {

std::unique_ptr<CompiledScript> compile_script(const Source& source) {
    auto compiled = std::make_unique<CompiledScript>();
    Diagnostics diagnostics;
    compiled->program = check_script(source, diagnostics);
    if (!diagnostics.has_errors()) {
        compiled->plan = plan_photon_loops(compiled->program, diagnostics);
        for (const PhotonLoop& loop : compiled->plan.loops) {
            EmittedPass& pass = compiled->passes.emplace_back();
            for (const Diagnostic& reason : loop.reasons)
                diagnostics.add(reason.code, reason.span, reason.message, reason.note);
            if (!loop.is_parallel || diagnostics.has_errors())
                continue;
            pass = emit_pass(compiled->program, loop);
            if (pass.too_long)
                diagnostics.add(pass.too_long->code, pass.too_long->span, pass.too_long->message, pass.too_long->note);
        }
    }
    compiled->diagnostics = diagnostics.sorted();
    compiled->has_errors = diagnostics.has_errors();
    return compiled;
}

void require_script(const CompiledScript& script) {
    if (script.has_errors)
        throw ScriptError(script.program.source, script.diagnostics);
}

} // namespace photonloupe::script
