// SPDX-License-Identifier: Apache-2.0
// Hands out names, uniform words and lane slots to what a pass uses.
#include <utility>

#include "script/emit/emitter.h"
#include "shared/script.h"

namespace photonloupe::script {

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
    m_pass.lanes = lay_out_lanes(m_program, m_loop);
    for (const ReducedSlots& slots : m_pass.lanes.variables) {
        m_has_element_reductions |= variable(slots.variable).array_size > 0;
        m_lane_of[slots.variable] = &slots;
    }
    if (m_pass.lanes.slots > 0)
        use("lanes");
    if (m_pass.lanes.pca_2d || m_pass.lanes.pca_3d)
        use("pca_lanes");
}

// Known when the script is compiled: needs no word.
bool Emitter::is_literal(std::uint32_t index) const {
    const Variable& v = variable(index);
    return v.constant && !v.exposed && v.array_size == 0 && !is_checked(index);
}

} // namespace photonloupe::script
