// SPDX-License-Identifier: Apache-2.0
// Derives the language from C's colors and the engine's table of builtins.
#include "studio/script_language.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "script/builtins.h"

namespace photonloupe::studio {
namespace {

constexpr std::size_t MOST_SUGGESTIONS = 12;
const char* const KEYWORDS[] = {"for",    "while",  "do",    "if",   "else", "break", "continue",
                                "return", "expose", "range", "step", "int",  "float", "function"};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

TextEditor::Language make_language() {
    TextEditor::Language language = *TextEditor::Language::C();
    language.name = "Photon script";
    language.preprocess = 0;
    language.keywords.clear();
    language.declarations.clear();
    language.identifiers.clear();
    for (const char* keyword : KEYWORDS)
        language.keywords.insert(keyword);
    for (const script::Builtin& builtin : script::list_builtins())
        language.identifiers.insert(std::string(builtin.name));
    for (const char* constant : {"X", "Y", "Z", "E", "Pi", "PI"})
        language.identifiers.insert(constant);
    return language;
}

} // namespace

const TextEditor::Language* find_script_language() {
    static const TextEditor::Language language = make_language();
    return &language;
}

void suggest_names(TextEditor::AutoCompleteState& state, const TextEditor& editor) {
    std::set<std::string> names(find_script_language()->identifiers.begin(), find_script_language()->identifiers.end());
    names.insert(std::begin(KEYWORDS), std::end(KEYWORDS));
    editor.IterateIdentifiers([&](const std::string& name) { names.insert(name); });
    const std::string term = lower(state.searchTerm);
    std::vector<std::string> within;
    state.suggestions.clear();
    for (const std::string& name : names) {
        const std::size_t at = lower(name).find(term);
        if (at == 0 && name != state.searchTerm)
            state.suggestions.push_back(name);
        else if (at != std::string::npos && at > 0)
            within.push_back(name);
    }
    state.suggestions.insert(state.suggestions.end(), within.begin(), within.end());
    if (state.suggestions.size() > MOST_SUGGESTIONS)
        state.suggestions.resize(MOST_SUGGESTIONS);
}

std::string explain_word(const std::string& word) {
    for (const script::Builtin& builtin : script::list_builtins())
        if (word == builtin.name)
            return std::string(builtin.signature) + "\n" + std::string(builtin.doc);
    return {};
}

} // namespace photonloupe::studio
