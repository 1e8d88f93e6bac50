// SPDX-License-Identifier: Apache-2.0
// The script in the editor: its text, what is wrong with it, and the variables it exposes.
#pragma once

#include <memory>
#include <string>

#include "script/compile_script.h"

namespace photonloupe::studio {

class ScriptDocument {
public:
    // Checks the text, unless it is the one already checked.
    void check(const std::string& text, const std::string& name);

    const script::CompiledScript* compiled() const { return m_compiled.get(); }
    bool has_errors() const { return m_compiled && m_compiled->has_errors; }
    std::size_t count_errors() const;
    std::uint64_t version() const { return m_version; } // rises with every check

private:
    std::string m_text;
    std::unique_ptr<script::CompiledScript> m_compiled;
    std::uint64_t m_version = 0;
};

} // namespace photonloupe::studio
