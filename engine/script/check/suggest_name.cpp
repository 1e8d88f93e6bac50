// SPDX-License-Identifier: Apache-2.0
// Compares names by case and by edit distance.
#include "script/check/suggest_name.h"

#include <algorithm>
#include <cctype>

namespace photonloupe::script {
namespace {

constexpr std::size_t MAX_COMPARED = 64; // longer names are nobody's misspelling

std::string lower(std::string_view name) {
    std::string result(name);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return result;
}

// Insertions, deletions, replacements and swaps of neighbors (optimal string alignment).
std::size_t measure_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        previous[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                current[j] = std::min(current[j], before[j - 2] + 1);
        }
        std::swap(before, previous);
        std::swap(previous, current);
    }
    return previous[b.size()];
}

} // namespace

std::string suggest_name(std::string_view written, const std::vector<std::string_view>& known) {
    if (written.size() > MAX_COMPARED)
        return {};
    const std::string wanted = lower(written);
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, written.size() / 3) + 1;
    if (written.size() < 3)
        best_distance = 1; // of short names any would be near: by case alone
    for (const std::string_view name : known) {
        if (name == written || name.size() > MAX_COMPARED)
            continue;
        const std::string candidate = lower(name);
        const std::size_t distance = candidate == wanted ? 0 : measure_distance(wanted, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = name;
        }
    }
    return best;
}

} // namespace photonloupe::script
