// SPDX-License-Identifier: Apache-2.0
// Counts values in bins; whole numbers, so that the order of photons does not matter.
#pragma binding uint histogram_words

// `words`: where the site's uniform words begin. No bins: its bounds or bins are out of range.
void script_histogram(uint words, float value, uint bad_range) {
    float lo = uintBitsToFloat(uniform_words[words]), hi = uintBitsToFloat(uniform_words[words + 1u]);
    uint bins = uniform_words[words + 2u], first = uniform_words[words + 3u];
    fault_if(bins == 0u, bad_range);
    if (bins == 0u || !is_committing) return;
    precise float place = (value - lo) / (hi - lo) * float(bins);
    uint bin = min(uint(clamp(place, 0.0, 4096.0)), bins - 1u);
    bin = value < lo ? bins : value > hi ? bins + 1u : bin;
    atomicAdd(histogram_words[first + (is_finite(value) ? bin : bins + 2u)], 1u);
}
