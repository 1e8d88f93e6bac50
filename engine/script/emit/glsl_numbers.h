// SPDX-License-Identifier: Apache-2.0
// Numbers as GLSL literals that glslang reads back bit by bit.
#pragma once

#include <string>

#include "script/program.h"

namespace photonloupe::script {

std::string write_number(Type type, double value);
std::string name_type(Type type);
// What an operation without a value gives: NaN, or 0.
std::string write_nothing(Type type);

} // namespace photonloupe::script
