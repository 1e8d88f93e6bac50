// SPDX-License-Identifier: Apache-2.0
// The table of diagnostic codes.
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

constexpr DiagnosticCode TABLE[] = {
    {codes::UNEXPECTED_CHARACTER, "A character or byte that no script holds outside comments and labels."},
    {codes::MALFORMED_NUMBER, "A number that runs into letters, or that no 32-bit float can hold."},
    {codes::UNENDED_TEXT, "A comment or label without its end, or a label with an unknown escape."},
    {codes::UNKNOWN_FUNCTION, "A call of a function that is neither predefined nor defined in the script."},
    {codes::SYNTAX, "Something else was expected here."},
    {codes::UNKNOWN_VARIABLE, "A variable that is given a value nowhere."},
    {codes::READ_BEFORE_SET, "A variable that can't have a value yet where it is read."},
    {codes::TOO_DEEP, "Blocks, parentheses, operators or calls are nested too deeply (64 levels)."},
    {codes::TOO_LONG, "The script is longer than 64 KiB."},
    {codes::TOO_MANY_VARIABLES, "More than 256 variables."},
    {codes::ARRAY_TOO_LARGE, "An array of more than 4,096 numbers, or of none."},
    {codes::TOO_MANY_ARRAY_NUMBERS, "The arrays declared inside one photon loop hold more than 512 numbers."},
    {codes::TOO_LARGE_INLINED, "The script is too large once every call has its own copy of its function."},
    {codes::ARGUMENT_COUNT, "A call with too few or too many arguments."},
    {codes::ARGUMENT_KIND, "A call with an argument of another kind: a label where a number belongs, or the reverse."},
    {codes::NOT_ASSIGNABLE, "Something that can't be assigned: a constant, a call, a number."},
    {codes::FUNCTION_WRITES_SCRIPT, "A function writes a variable of the script; it may only read one."},
    {codes::RECURSION, "Functions that call themselves, directly or through others."},
    {codes::ARRAY_MISUSE, "An array without an index, or an index on what is no array."},
    {codes::REAL_TO_INTEGER, "A real number where the script declares an integer."},
    {codes::INDEX_OUTSIDE, "An index outside its array or list."},
    {codes::AXIS_OUTSIDE, "An axis or channel other than 0, 1 and 2."},
    {codes::NEGATIVE_ID, "A negative photon or vertex."},
    {codes::NOT_WHOLE, "An index, photon, vertex, axis, dimension or count that is not a whole number."},
    {codes::COUNT_OUTSIDE, "A number of neighbors or of bins that is out of its range."},
    {codes::NOT_UNIFORM, "An argument that must be the same for all photons depends on the photon."},
    {codes::BAD_RANGE, "A range out of order; an exposed variable without a default, or with one outside its range."},
    {codes::EXPOSED_INSIDE, "`expose` inside a loop or function."},
    {codes::DECLARED_INSIDE, "declarePhotonParameter inside a photon loop."},
    {codes::BAD_DIMENSION, "A parameter's dimension outside 3-15, declared twice, or leaving a gap."},
    {codes::UNDECLARED_DIMENSION, "A parameter is set that is declared nowhere."},
    {codes::JUMP_OUTSIDE, "`break` or `continue` outside a loop, or `return` outside a function."},
    {codes::NAME_TAKEN, "A name that is defined already, or that the language reserves."},
    {codes::NO_VALUE, "The value of a function that returns none; a return without the value returned elsewhere."},
    {codes::LIST_MISUSE, "A neighbor list used otherwise than as list[j] and length(list)."},
    {codes::TEXT_MISUSE, "A label where a number belongs."},
    {codes::UNSUPPORTED_OPERATOR, "An operator of C that scripts do not have."},
    {codes::NOT_CONSTANT, "An array's size that is not known when the script is compiled."},
    {codes::REAL_LOOP_VARIABLE, "A loop over photons that is none, since its variable holds real numbers elsewhere."},
    {codes::SETS_AND_QUERIES, "Parameters are set, and neighbors in parameter space sought, in one loop over photons."},
    {codes::PASS_TOO_LONG, "A loop over photons that becomes more than 128 KiB of GLSL."},
    {codes::KEEPS_VALUE, "A serial loop: a variable keeps its value from photon to photon, or is read after the loop."},
    {codes::REDUCED_AND_USED, "A serial loop: a variable is summed, minimized or maximized and also used otherwise."},
    {codes::LEAVES_LOOP, "A serial loop: it ends early, or its variable is assigned."},
    {codes::OTHER_PHOTON, "A serial loop: other photons are written, or their parameters read while they are set."},
    {codes::KEEPS_POINTS, "A serial loop: a PCA keeps points from photon to photon, or is read after the loop."},
};

} // namespace

std::span<const DiagnosticCode> list_diagnostic_codes() {
    return TABLE;
}

} // namespace photonloupe::script
