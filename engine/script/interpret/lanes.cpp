// SPDX-License-Identifier: Apache-2.0
// Combines lanes and blocks pairwise; results pairwise again; an odd one out moves up unchanged.
#include "script/interpret/lanes.h"

#include <algorithm>
#include <array>
#include <bit>

#include "shared/script.h"

namespace photonloupe::script {
namespace {

static_assert(sizeof(Moments) == sizeof(std::uint32_t) * shared::MOMENTS_WORDS);

Number to_number(std::uint32_t word) {
    return std::bit_cast<Number>(word);
}

std::uint32_t to_word(Number number) {
    return std::bit_cast<std::uint32_t>(number);
}

const ReducedSlots* find_payloads_next(const LaneLayout& layout, std::uint32_t choice, const ReducedSlots* after) {
    for (const ReducedSlots& slots : layout.variables)
        if (slots.role == Role::payload && slots.of == choice && (!after || &slots > after))
            return &slots;
    return nullptr;
}

// Two lanes' (or totals') words, `stride` apart from slot to slot, into the first.
struct Pair {
    std::uint32_t* mine;
    const std::uint32_t* other;
    std::size_t stride;

    void combine(const ReducedSlots& slots) const {
        for (std::size_t i = slots.first; i < slots.first + slots.size; ++i)
            mine[i * stride] = to_word(
                script::combine(slots.role, slots.type, to_number(mine[i * stride]), to_number(other[i * stride])));
    }

    void choose(const LaneLayout& layout, const ReducedSlots& slots) const {
        for (std::size_t i = 0; i < slots.size; ++i) {
            const std::size_t value = (slots.first + i) * stride, photon = (slots.first + slots.size + i) * stride;
            if (!wins(slots.role, slots.type, {to_number(other[value]), other[photon]},
                      {to_number(mine[value]), mine[photon]}))
                continue;
            mine[value] = other[value];
            mine[photon] = other[photon];
            for (const ReducedSlots* payload = find_payloads_next(layout, slots.variable, nullptr); payload;
                 payload = find_payloads_next(layout, slots.variable, payload))
                mine[(payload->first + i) * stride] = other[(payload->first + i) * stride];
        }
    }

    void merge(std::uint32_t first) const {
        std::uint32_t a[shared::MOMENTS_WORDS], b[shared::MOMENTS_WORDS];
        for (std::size_t i = 0; i < shared::MOMENTS_WORDS; ++i) {
            a[i] = mine[(first + i) * stride];
            b[i] = other[(first + i) * stride];
        }
        store_moments(merge_moments(load_moments(a), load_moments(b)), a);
        for (std::size_t i = 0; i < shared::MOMENTS_WORDS; ++i)
            mine[(first + i) * stride] = a[i];
    }

    void join(const LaneLayout& layout) const {
        for (const ReducedSlots& slots : layout.variables) {
            if (is_choice(slots.role))
                choose(layout, slots);
            else if (slots.role != Role::payload)
                combine(slots);
        }
        if (layout.pca_2d)
            merge(*layout.pca_2d);
        if (layout.pca_3d)
            merge(*layout.pca_3d);
    }
};

void set_payloads(const LaneLayout& layout, std::span<const std::uint32_t> total, const ReducedSlots& choice,
                  std::size_t element, ScriptState& state) {
    for (const ReducedSlots* payload = find_payloads_next(layout, choice.variable, nullptr); payload;
         payload = find_payloads_next(layout, choice.variable, payload)) {
        VariableState& variable = state.variables[payload->variable];
        variable.numbers[element] = to_number(total[payload->first + element]);
        variable.is_set = true;
    }
}

// What was pushed before the loop was pushed first, whichever photon pushed it.
Moments append_moments(const Moments& before, const Moments& total) {
    Moments merged = merge_moments(before, total);
    if (before.count > 0) {
        merged.first_photon = before.first_photon;
        std::ranges::copy(before.first_point, merged.first_point);
    }
    return merged;
}

} // namespace

std::vector<std::uint32_t> make_identity(const LaneLayout& layout) {
    std::vector<std::uint32_t> words(layout.slots);
    for (const ReducedSlots& slots : layout.variables) {
        const auto first = words.begin() + slots.first;
        std::fill_n(first, slots.size, to_word(find_identity(slots.role, slots.type)));
        if (is_choice(slots.role))
            std::fill_n(first + slots.size, slots.size, 0xffffffffu);
    }
    for (const std::optional<std::uint32_t>& first : {layout.pca_2d, layout.pca_3d})
        if (first)
            store_moments({}, std::span(words).subspan(*first, shared::MOMENTS_WORDS));
    return words;
}

std::vector<std::uint32_t> combine_lanes(const LaneLayout& layout, std::span<const std::uint32_t> words,
                                         std::uint32_t lanes) {
    std::vector<std::uint32_t> work(words.begin(), words.end());
    for (std::uint32_t step = 1; step < lanes; step *= 2)
        for (std::uint32_t lane = 0; lane + step < lanes; lane += 2 * step)
            Pair{&work[lane], &work[lane + step], lanes}.join(layout);
    std::vector<std::uint32_t> total(layout.slots);
    for (std::size_t slot = 0; slot < layout.slots; ++slot)
        total[slot] = work[slot * lanes];
    return total;
}

std::vector<std::uint32_t> combine_blocks(const LaneLayout& layout,
                                          const std::vector<std::vector<std::uint32_t>>& blocks) {
    if (blocks.empty())
        return make_identity(layout);
    std::vector<std::vector<std::uint32_t>> work = blocks;
    for (std::size_t step = 1; step < work.size(); step *= 2)
        for (std::size_t block = 0; block + step < work.size(); block += 2 * step)
            Pair{work[block].data(), work[block + step].data(), 1}.join(layout);
    return work[0];
}

void bring_back(const LaneLayout& layout, std::span<const std::uint32_t> total, ScriptState& state) {
    for (const ReducedSlots& slots : layout.variables) {
        if (slots.role == Role::payload)
            continue; // goes with its choice
        VariableState& variable = state.variables[slots.variable];
        for (std::size_t i = 0; i < slots.size; ++i) {
            const Number found = to_number(total[slots.first + i]);
            if (!is_choice(slots.role)) {
                variable.numbers[i] = combine(slots.role, slots.type, variable.numbers[i], found);
            } else if (const Choice before{variable.numbers[i], 0}, best{found, total[slots.first + slots.size + i]};
                       wins(slots.role, slots.type, best, before)) {
                variable.numbers[i] = found;
                set_payloads(layout, total, slots, i, state);
            }
        }
    }
    if (layout.pca_2d)
        state.pca_2d = append_moments(state.pca_2d, load_moments(total.subspan(*layout.pca_2d)));
    if (layout.pca_3d)
        state.pca_3d = append_moments(state.pca_3d, load_moments(total.subspan(*layout.pca_3d)));
}

void store_moments(const Moments& moments, std::span<std::uint32_t> words) {
    std::ranges::copy(std::bit_cast<std::array<std::uint32_t, shared::MOMENTS_WORDS>>(moments), words.begin());
}

Moments load_moments(std::span<const std::uint32_t> words) {
    std::array<std::uint32_t, shared::MOMENTS_WORDS> packed;
    std::copy_n(words.begin(), packed.size(), packed.begin());
    return std::bit_cast<Moments>(packed);
}

} // namespace photonloupe::script
