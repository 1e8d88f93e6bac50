// SPDX-License-Identifier: Apache-2.0
// Arithmetic and comparisons: wrapping 32-bit integers, 32-bit floats as IEEE has them.
#include "script/check/apply_operator.h"

#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

template <class T>
std::int32_t compare(Operator operation, T a, T b) {
    switch (operation) {
    case Operator::equal:
        return a == b;
    case Operator::not_equal:
        return a != b;
    case Operator::less:
        return a < b;
    case Operator::less_equal:
        return a <= b;
    case Operator::greater:
        return a > b;
    default:
        return a >= b;
    }
}

std::int32_t compute(Operator operation, std::int32_t a, std::int32_t b) {
    switch (operation) {
    case Operator::add:
        return add_wrapping(a, b);
    case Operator::subtract:
        return subtract_wrapping(a, b);
    case Operator::multiply:
        return multiply_wrapping(a, b);
    default:
        return compute_remainder(a, b);
    }
}

float compute(Operator operation, float a, float b) {
    switch (operation) {
    case Operator::add:
        return a + b;
    case Operator::subtract:
        return a - b;
    case Operator::multiply:
        return a * b;
    case Operator::divide:
        return a / b;
    default:
        return compute_remainder(a, b);
    }
}

bool is_arithmetic(Operator operation) {
    return operation >= Operator::add && operation <= Operator::modulo;
}

} // namespace

bool is_true(Type type, Number value) {
    return type == Type::integer ? value.integer != 0 : value.real != 0;
}

Number apply_unary(Operator operation, Type type, Number value) {
    if (operation == Operator::logical_not)
        return {.integer = !is_true(type, value)};
    if (type == Type::integer)
        return {.integer = subtract_wrapping(0, value.integer)};
    return {.real = -value.real};
}

Number apply_operator(Operator operation, Type type, Number a, Number b) {
    if (!is_arithmetic(operation))
        return {.integer = type == Type::integer ? compare(operation, a.integer, b.integer)
                                                 : compare(operation, a.real, b.real)};
    if (type == Type::integer)
        return {.integer = compute(operation, a.integer, b.integer)};
    return {.real = compute(operation, a.real, b.real)};
}

} // namespace photonloupe::script
