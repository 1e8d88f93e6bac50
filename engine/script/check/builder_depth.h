// SPDX-License-Identifier: Apache-2.0
// The tree builder's bound on recursion, which planner, emitter and interpreter inherit with the tree.
#pragma once

#include "script/check/tree_builder.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {

// Statements, expressions and inlined calls together: about what a megabyte of stack allows a careless visitor.
constexpr std::uint32_t MAX_TREE_DEPTH = 1024;
// Statements, expressions and variables with every function's copies.
constexpr std::uint32_t MAX_TREE_NODES = 65536;

class TreeBuilder::Depth {
public:
    Depth(TreeBuilder& builder, Span span) : m_builder(builder) {
        if (m_builder.m_depth >= MAX_TREE_DEPTH) {
            m_builder.m_diagnostics.add(codes::TOO_DEEP, span, "nested too deeply once functions are inlined",
                                        "split it up");
            throw TooLarge();
        }
        ++m_builder.m_depth;
    }
    ~Depth() { --m_builder.m_depth; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;

private:
    TreeBuilder& m_builder;
};

} // namespace photonloupe::script
