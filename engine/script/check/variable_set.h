// SPDX-License-Identifier: Apache-2.0
// A set of a program's variables.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace photonloupe::script {

class VariableSet {
public:
    explicit VariableSet(std::size_t count = 0) : m_words((count + 63) / 64) {}

    bool contains(std::uint32_t variable) const {
        return variable / 64 < m_words.size() && (m_words[variable / 64] >> variable % 64 & 1u) != 0;
    }
    void insert(std::uint32_t variable) {
        if (variable / 64 >= m_words.size())
            m_words.resize(variable / 64 + 1);
        m_words[variable / 64] |= std::uint64_t(1) << variable % 64;
    }
    void erase(std::uint32_t variable) {
        if (contains(variable))
            m_words[variable / 64] &= ~(std::uint64_t(1) << variable % 64);
    }
    void unite(const VariableSet& other) {
        m_words.resize(std::max(m_words.size(), other.m_words.size()));
        for (std::size_t i = 0; i < other.m_words.size(); ++i)
            m_words[i] |= other.m_words[i];
    }
    void intersect(const VariableSet& other) {
        for (std::size_t i = 0; i < m_words.size(); ++i)
            m_words[i] &= i < other.m_words.size() ? other.m_words[i] : 0;
    }

private:
    std::vector<std::uint64_t> m_words;
};

} // namespace photonloupe::script
