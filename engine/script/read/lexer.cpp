// SPDX-License-Identifier: Apache-2.0
// Splits a script's text into tokens; any bytes at all are either tokens or a diagnostic.
#include <algorithm>
#include <iterator>

#include "script/read/diagnostic_codes.h"
#include "script/read/read_number.h"
#include "script/read/tokens.h"
#include "script/read/utf8.h"

namespace photonloupe::script {
namespace {

constexpr std::string_view KEYWORDS[] = {"if",       "else",   "for",   "while", "do",       "break",
                                         "continue", "return", "float", "int",   "function", "expose"};

// Longest first, so that the first match is the right one.
constexpr std::string_view SYMBOLS[] = {"<<=", ">>=", "<<", ">>", "->", "&=", "|=", "^=", "++", "--", "+=", "-=",
                                        "*=",  "/=",  "%=", "==", "!=", "<=", ">=", "&&", "||", "&",  "|",  "^",
                                        "~",   ".",   "+",  "-",  "*",  "/",  "%",  "=",  "!",  "<",  ">",  "?",
                                        ":",   ";",   ",",  "(",  ")",  "{",  "}",  "[",  "]"};
// Those of C alone: they are read whole to be refused by name.
constexpr std::string_view UNSUPPORTED[] = {"<<=", ">>=", "<<", ">>", "->", "&=", "|=", "^=", "&", "|", "^", "~", "."};

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

class Lexer {
public:
    Lexer(const Source& source, Diagnostics& diagnostics) : m_text(source.text), m_diagnostics(diagnostics) {
        if (m_text.starts_with("\xEF\xBB\xBF"))
            m_at = 3; // a byte-order mark
    }

    std::vector<Token> split() {
        while (skip_blanks()) {
            const char c = m_text[m_at];
            if (is_letter(c))
                read_word();
            else if (is_digit(c) || (c == '.' && is_digit(peek(1))))
                read_number();
            else if (c == '"')
                read_label();
            else if (!read_symbol())
                refuse_characters();
        }
        Token end;
        end.span = {std::uint32_t(m_text.size()), std::uint32_t(m_text.size())};
        m_tokens.push_back(end);
        return std::move(m_tokens);
    }

private:
    char peek(std::size_t ahead) const { return m_at + ahead < m_text.size() ? m_text[m_at + ahead] : '\0'; }
    Span span_from(std::size_t begin) const { return {std::uint32_t(begin), std::uint32_t(m_at)}; }

    Token& add(TokenKind kind, std::size_t begin) {
        Token token;
        token.kind = kind;
        token.span = span_from(begin);
        token.spelling = m_text.substr(begin, m_at - begin);
        return m_tokens.emplace_back(std::move(token));
    }

    // False at the end of the text.
    bool skip_blanks() {
        while (m_at < m_text.size()) {
            const char c = m_text[m_at];
            if (c == ' ' || (c >= '\t' && c <= '\r')) {
                ++m_at;
            } else if (c == '/' && peek(1) == '/') {
                m_at = std::min(m_text.find_first_of("\r\n", m_at), m_text.size());
            } else if (c == '/' && peek(1) == '*') {
                skip_comment();
            } else {
                return true;
            }
        }
        return false;
    }

    void skip_comment() {
        const std::size_t begin = m_at;
        const std::size_t end = m_text.find("*/", m_at + 2);
        m_at = begin + 2;
        if (end == std::string_view::npos)
            m_diagnostics.add(codes::UNENDED_TEXT, span_from(begin), "this comment never ends", "close it with */");
        m_at = end == std::string_view::npos ? m_text.size() : end + 2;
    }

    void read_word() {
        const std::size_t begin = m_at;
        while (is_letter(peek(0)) || is_digit(peek(0)))
            ++m_at;
        Token& token = add(TokenKind::identifier, begin);
        if (std::find(std::begin(KEYWORDS), std::end(KEYWORDS), token.spelling) != std::end(KEYWORDS))
            token.kind = TokenKind::keyword;
    }

    void read_number() {
        const std::size_t begin = m_at;
        const NumberReading reading = script::read_number(m_text.substr(m_at));
        m_at += reading.length;
        Token& token = add(TokenKind::number, begin);
        token.is_integer = reading.is_integer;
        token.integer = reading.integer;
        token.value = reading.value;
        if (!reading.problem.empty())
            m_diagnostics.add(codes::MALFORMED_NUMBER, token.span, std::string(reading.problem));
    }

    void read_label() {
        const std::size_t begin = m_at++;
        std::string label;
        while (m_at < m_text.size() && m_text[m_at] != '"' && m_text[m_at] != '\n' && m_text[m_at] != '\r')
            read_label_character(label);
        if (peek(0) == '"') {
            ++m_at;
        } else {
            m_diagnostics.add(codes::UNENDED_TEXT, span_from(begin), "this label has no closing quote on its line");
        }
        add(TokenKind::text, begin).label = std::move(label);
    }

    void read_label_character(std::string& label) {
        const std::size_t begin = m_at;
        const Utf8Character character = decode_utf8(m_text, m_at);
        m_at += character.length;
        if (m_text[begin] == '\\') {
            const std::size_t which = std::string_view("\"\\nt").find(peek(0));
            if (m_at < m_text.size() && which != std::string_view::npos) {
                label += "\"\\\n\t"[which];
                ++m_at;
            } else {
                m_diagnostics.add(codes::UNENDED_TEXT, span_from(begin), "labels know no such escape",
                                  "\\\" \\\\ \\n and \\t there are");
            }
        } else if (is_printable(character)) {
            label += m_text.substr(begin, character.length);
        } else {
            m_diagnostics.add(codes::UNEXPECTED_CHARACTER, span_from(begin),
                              describe(begin, character) + " in a label");
        }
    }

    bool read_symbol() {
        const std::string_view rest = m_text.substr(m_at);
        const auto found = std::find_if(std::begin(SYMBOLS), std::end(SYMBOLS),
                                        [&](std::string_view symbol) { return rest.starts_with(symbol); });
        if (found == std::end(SYMBOLS))
            return false;
        const std::size_t begin = m_at;
        m_at += found->size();
        const bool is_known =
            std::find(std::begin(UNSUPPORTED), std::end(UNSUPPORTED), *found) == std::end(UNSUPPORTED);
        add(is_known ? TokenKind::symbol : TokenKind::unsupported, begin);
        return true;
    }

    // A run of them is one complaint.
    void refuse_characters() {
        const std::size_t begin = m_at;
        const Utf8Character first = decode_utf8(m_text, m_at);
        std::string note;
        if (first.code_point == '#')
            note = "there is no preprocessor";
        else if (first.is_valid && first.code_point == 0x2212u)
            note = "a minus is written '-'";
        else if (first.is_valid && (first.code_point == 0x201Cu || first.code_point == 0x201Du))
            note = "labels stand between straight quotes";
        else if (first.code_point == '\'')
            note = "labels stand between double quotes";
        do {
            m_at += decode_utf8(m_text, m_at).length;
        } while (m_at < m_text.size() && !is_expected(m_text[m_at]));
        m_diagnostics.add(codes::UNEXPECTED_CHARACTER, span_from(begin), "unexpected " + describe(begin, first), note);
        if (first.code_point == '#')
            m_at = std::min(m_text.find_first_of("\r\n", m_at), m_text.size());
        else if (note.empty() || first.code_point == 0x2212u) // where an operator may have been meant
            add(TokenKind::unsupported, begin).is_reported = true;
    }

    static bool is_expected(char c) {
        return c == ' ' || (c >= '\t' && c <= '\r') || is_letter(c) || is_digit(c) || c == '"' || c == '.' ||
               std::any_of(std::begin(SYMBOLS), std::end(SYMBOLS),
                           [c](std::string_view symbol) { return symbol.front() == c; });
    }

    // "character 'é'" or "byte 0x07".
    std::string describe(std::size_t at, const Utf8Character& character) const {
        if (is_printable(character))
            return "character '" + std::string(m_text.substr(at, character.length)) + "'";
        constexpr char DIGITS[] = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(m_text[at]);
        return std::string("byte 0x") + DIGITS[byte >> 4] + DIGITS[byte & 15];
    }

    std::string_view m_text;
    Diagnostics& m_diagnostics;
    std::size_t m_at = 0;
    std::vector<Token> m_tokens;
};

} // namespace

std::vector<Token> split_tokens(const Source& source, Diagnostics& diagnostics) {
    return Lexer(source, diagnostics).split();
}

} // namespace photonloupe::script
