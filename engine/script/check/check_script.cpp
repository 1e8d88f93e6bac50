// SPDX-License-Identifier: Apache-2.0
// The checker's stages in the order they run.
#include "script/check/check_script.h"

#include <algorithm>

#include "script/check/check_stages.h"
#include "script/check/evaluate_constant.h"
#include "script/check/tree_builder.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

// Where parts of the script could not be read, what they may have set and defined is not known to be missing.
constexpr std::string_view CODES_OF_MISSING[] = {codes::UNKNOWN_FUNCTION, codes::UNKNOWN_VARIABLE,
                                                 codes::READ_BEFORE_SET,  codes::BAD_RANGE,
                                                 codes::BAD_DIMENSION,    codes::UNDECLARED_DIMENSION};

void check_meaning(Draft& draft, Diagnostics& diagnostics) {
    infer_types(draft);
    convert_types(draft, diagnostics);
    find_constants(draft);
    resolve_array_sizes(draft, diagnostics);
    check_assignment(draft, diagnostics);
    find_constants(draft); // again: now it is known which reads may find nothing
    find_photon_loops(draft, diagnostics);
    bound_loops(draft);
    check_values(draft, diagnostics);
    check_uniform_arguments(draft, diagnostics);
    check_photon_arrays(draft, diagnostics);
    check_exposed(draft, diagnostics);
}

// Functions that nothing calls have been checked and are not part of the program.
void drop_uncalled(Draft& draft) {
    draft.program.body.resize(draft.called.statements);
    draft.program.functions.resize(draft.called.functions);
    draft.program.variables.resize(draft.called.variables);
}

void check_tree(const SyntaxScript& script, Draft& draft, Diagnostics& diagnostics) {
    const FunctionTable functions = build_function_table(script, diagnostics);
    if (!check_recursion(functions, diagnostics))
        return;
    TreeBuilder(script, functions, draft, diagnostics).build();
    if (draft.is_too_large)
        return;
    check_meaning(draft, diagnostics);
    drop_uncalled(draft);
    check_parameters(draft, diagnostics);
    draft.program.columns = find_columns(draft.program);
}

} // namespace

Program check_script(const Source& source, Diagnostics& diagnostics) {
    Draft draft;
    draft.program.source = source;
    const SyntaxScript script = parse_script(source, diagnostics);
    Diagnostics found;
    check_tree(script, draft, found);
    for (const Diagnostic& diagnostic : found.all()) {
        const bool is_of_missing = std::find(std::begin(CODES_OF_MISSING), std::end(CODES_OF_MISSING),
                                             diagnostic.code) != std::end(CODES_OF_MISSING);
        if (script.is_complete || !is_of_missing)
            diagnostics.add(diagnostic.code, diagnostic.span, diagnostic.message, diagnostic.note);
    }
    return std::move(draft.program);
}

} // namespace photonloupe::script
