// SPDX-License-Identifier: Apache-2.0
// Hands out names, uniform words and lane slots to what a pass uses.
#include <utility>

#include "script/emitter.h"
#include "shared/script.h"

namespace photonloupe::script {
namespace {

bool is_choice(Role role) {
    return role == Role::least || role == Role::greatest;
}

} // namespace

void Emitter::name_variables() {
    m_taken = {"v_0"};
    for (const auto& [index, use] : m_loop.variables) {
        const std::string& name = variable(index).name;
        m_names[index] = make_name("v_", name);
        if (is_checked(index))
            m_set_flags[index] = make_unique(m_names[index] + "_is_set");
        if (is_choice(use.role))
            m_photon_names[index] = make_unique(m_names[index] + "_photon");
    }
}

void Emitter::plan_words() {
    const auto take_words = [this](std::uint32_t count) {
        return std::exchange(m_pass.uniform_word_count, m_pass.uniform_word_count + count);
    };
    for (const auto& [index, use] : m_loop.variables) {
        const Variable& v = variable(index);
        if (use.role != Role::uniform || is_literal(index))
            continue;
        UniformSlot slot{index, take_words(v.type == Type::list ? 2 : std::max(1u, v.array_size)), {}};
        if (is_checked(index))
            slot.set_word = take_words(1);
        m_word_of[index] = slot.first_word;
        m_pass.uniforms.push_back(slot);
    }
    if (m_loop.pca_2d == AccumulatorUse::uniform)
        m_pass.moments_2d_word = take_words(shared::MOMENTS_WORDS);
    if (m_loop.pca_3d == AccumulatorUse::uniform)
        m_pass.moments_3d_word = take_words(shared::MOMENTS_WORDS);
    if (m_loop.decomposition == AccumulatorUse::uniform)
        m_pass.decomposition_word = take_words(shared::DECOMPOSITION_WORDS);
    if (m_pass.moments_2d_word || m_pass.moments_3d_word || m_pass.decomposition_word)
        use("pca_words");
    for (const NeighborQuery& query : m_loop.queries)
        m_pass.queries.push_back({&query, take_words(shared::QUERY_STRIDE)});
}

void Emitter::plan_slots() {
    const auto take_slots = [this](std::uint32_t count) {
        return std::exchange(m_pass.slot_count, m_pass.slot_count + count);
    };
    for (const auto& [index, use] : m_loop.variables) {
        if (!is_reduced(index))
            continue;
        const std::uint32_t size = std::max(1u, variable(index).array_size);
        m_has_element_reductions |= variable(index).array_size > 0;
        LaneSlots slots{index, use, size, take_slots(size), {}};
        if (is_choice(use.role))
            slots.photon_slot = take_slots(size);
        m_pass.lanes.push_back(slots);
    }
    for (const LaneSlots& slots : m_pass.lanes)
        m_lane_of[slots.variable] = &slots;
    if (m_loop.pca_2d == AccumulatorUse::reduction)
        m_pass.moments_2d_slot = take_slots(shared::MOMENTS_WORDS);
    if (m_loop.pca_3d == AccumulatorUse::reduction)
        m_pass.moments_3d_slot = take_slots(shared::MOMENTS_WORDS);
    if (m_pass.slot_count > 0)
        use("lanes");
    if (m_pass.moments_2d_slot || m_pass.moments_3d_slot)
        use("pca_lanes");
}

// Known when the script is compiled: needs no word.
bool Emitter::is_literal(std::uint32_t index) const {
    const Variable& v = variable(index);
    return v.constant && !v.exposed && v.array_size == 0 && !is_checked(index);
}

} // namespace photonloupe::script
