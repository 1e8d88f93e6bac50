// SPDX-License-Identifier: Apache-2.0
// Random bytes, random tokens and mutated scripts never crash the language.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "fuzz/script_fuzz_entry.h"
#include "script/builtins.h"
#include "script/script_files.h"

namespace photonloupe::test {
namespace {

void fuzz(const std::string& text) {
    fuzz_script(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

TEST(ScriptFuzz, random_bytes_do_no_harm) {
    std::mt19937 engine(1);
    for (int round = 0; round < 2000; ++round) {
        std::string text(engine() % 400, '\0');
        for (char& c : text)
            c = char(engine());
        fuzz(text);
    }
}

// Bytes rarely get past the lexer; words do.
TEST(ScriptFuzz, random_words_do_no_harm) {
    std::vector<std::string> words = {"if",
                                      "else",
                                      "for",
                                      "while",
                                      "do",
                                      "break",
                                      "continue",
                                      "return",
                                      "float",
                                      "int",
                                      "function",
                                      "expose",
                                      "range",
                                      "step",
                                      "(",
                                      ")",
                                      "{",
                                      "}",
                                      "[",
                                      "]",
                                      ";",
                                      ";",
                                      ";",
                                      ",",
                                      "=",
                                      "=",
                                      "+=",
                                      "++",
                                      "--",
                                      "+",
                                      "-",
                                      "*",
                                      "/",
                                      "%",
                                      "<",
                                      ">",
                                      "==",
                                      "&&",
                                      "||",
                                      "!",
                                      "?",
                                      ":",
                                      "a",
                                      "b",
                                      "nn",
                                      "i",
                                      "n",
                                      "X",
                                      "E",
                                      "Pi",
                                      "true",
                                      "0",
                                      "1",
                                      "2",
                                      "3",
                                      "0.5",
                                      "1e30",
                                      "\"t\"",
                                      "f",
                                      "g",
                                      "\n",
                                      "getNumPhotons()",
                                      "for (i = 0; i < getNumPhotons(); i++) {",
                                      "function f(a, b) {",
                                      "float c[5];"};
    for (const script::Builtin& builtin : script::list_builtins())
        words.push_back(std::string(builtin.name) + "(");
    std::mt19937 engine(2);
    for (int round = 0; round < 4000; ++round) {
        std::string text;
        for (std::uint32_t length = engine() % 120; length > 0; --length)
            text += words[engine() % words.size()] + (engine() % 3 ? " " : "");
        fuzz(text);
    }
}

TEST(ScriptFuzz, mutated_scripts_do_no_harm) {
    std::vector<std::string> scripts;
    for (const char* const folder : {"accept", "reject"})
        for (const auto& path : list_scripts(folder))
            if (const std::string text = read_script(path).text; text.size() < 8000)
                scripts.push_back(text);
    std::mt19937 engine(3);
    for (int round = 0; round < 4000; ++round) {
        std::string text = scripts[engine() % scripts.size()];
        for (std::uint32_t mutation = 1 + engine() % 4; mutation > 0 && !text.empty(); --mutation) {
            const std::size_t at = engine() % text.size();
            const std::size_t length = std::min<std::size_t>(1 + engine() % 30, text.size() - at);
            const std::string& other = scripts[engine() % scripts.size()];
            switch (engine() % 4) {
            case 0:
                text[at] = char(engine());
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, text.substr(engine() % text.size(), length));
                break;
            default:
                if (!other.empty())
                    text.replace(at, length, other.substr(engine() % other.size(), length));
            }
        }
        fuzz(text);
    }
}

} // namespace
} // namespace photonloupe::test
