// SPDX-License-Identifier: Apache-2.0
// Reads components byte by byte, so that no alignment is needed.
#include "scene/accessor_column.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace photonloupe {
namespace {

template <class Number>
Number read_component(const AccessorColumn& column, std::uint64_t element, std::uint32_t component) {
    Number number;
    std::memcpy(&number, column.bytes + element * column.stride + component * sizeof number, sizeof number);
    return number;
}

template <class Integer>
double read_integer(const AccessorColumn& column, std::uint64_t element, std::uint32_t component) {
    const double value = read_component<Integer>(column, element, component);
    return column.is_normalized ? std::max(value / std::numeric_limits<Integer>::max(), -1.0) : value;
}

} // namespace

double AccessorColumn::read(std::uint64_t element, std::uint32_t component) const {
    switch (component_type) {
    case COMPONENT_BYTE:
        return read_integer<std::int8_t>(*this, element, component);
    case COMPONENT_UNSIGNED_BYTE:
        return read_integer<std::uint8_t>(*this, element, component);
    case COMPONENT_SHORT:
        return read_integer<std::int16_t>(*this, element, component);
    case COMPONENT_UNSIGNED_SHORT:
        return read_integer<std::uint16_t>(*this, element, component);
    case COMPONENT_UNSIGNED_INT:
        return read_integer<std::uint32_t>(*this, element, component);
    default:
        return double(read_component<float>(*this, element, component));
    }
}

std::uint32_t AccessorColumn::read_unsigned(std::uint64_t element, std::uint32_t component) const {
    if (component_type == COMPONENT_UNSIGNED_BYTE)
        return read_component<std::uint8_t>(*this, element, component);
    if (component_type == COMPONENT_UNSIGNED_SHORT)
        return read_component<std::uint16_t>(*this, element, component);
    return read_component<std::uint32_t>(*this, element, component);
}

} // namespace photonloupe
