// SPDX-License-Identifier: Apache-2.0
// Reads values of a JSON document while remembering where they stand, so that every refusal can name the place.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace photonloupe {

using Json = nlohmann::json;

// One value of the document, or the place where one is missing (`value` is null).
struct JsonPlace {
    const Json* value = nullptr;
    std::string path; // JSON pointer: "/accessors/3"
    const std::string* file = nullptr;
};

// Throws SceneError "file: path: what; remedy".
[[noreturn]] void refuse(const JsonPlace& place, std::string_view what, std::string_view remedy);

// Text from the file as it may be shown: quoted, shortened, without control characters.
std::string quote_text(std::string_view text);

// The member of an object; a missing one has no value. Refuses parents that are not objects.
JsonPlace find_member(const JsonPlace& object, const char* key);
// As find_member, but refuses when it is missing.
JsonPlace require_member(const JsonPlace& object, const char* key);
JsonPlace get_element(const JsonPlace& array, std::size_t index);

// Number of elements; 0 when missing. Refuses anything but arrays, and arrays longer than `limit`.
std::size_t count_elements(const JsonPlace& array, std::size_t limit);
// A whole number in [0, limit] (2.0 counts as 2).
std::uint64_t read_unsigned(const JsonPlace& place, std::uint64_t limit);
std::uint64_t read_unsigned_or(const JsonPlace& place, std::uint64_t limit, std::uint64_t fallback);
// An index into an array of `count` entries; nothing when missing.
std::optional<std::uint32_t> read_index(const JsonPlace& place, std::size_t count, std::string_view what);

struct NumberRange {
    double lo = -std::numeric_limits<double>::max();
    double hi = std::numeric_limits<double>::max();
};
double read_number(const JsonPlace& place, NumberRange range = {});
double read_number_or(const JsonPlace& place, double fallback, NumberRange range = {});
// Exactly `count` numbers; `fallback` when missing.
std::vector<double> read_numbers_or(const JsonPlace& place, std::vector<double> fallback, NumberRange range = {});
std::string read_string(const JsonPlace& place);
std::string read_string_or(const JsonPlace& place, std::string_view fallback);
bool read_flag_or(const JsonPlace& place, bool fallback);

} // namespace photonloupe
