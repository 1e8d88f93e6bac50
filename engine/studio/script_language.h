// SPDX-License-Identifier: Apache-2.0
// What the editor knows of the script language: colors, completions and explanations, from the table of builtins.
#pragma once

#include <TextEditor.h>

#include <string>

namespace photonloupe::studio {

const TextEditor::Language* find_script_language();
// Names that begin with, then those that contain the term; variables of the text among them.
void suggest_names(TextEditor::AutoCompleteState& state, const TextEditor& editor);
// Signature and explanation of a builtin; empty: the word is none.
std::string explain_word(const std::string& word);

} // namespace photonloupe::studio
