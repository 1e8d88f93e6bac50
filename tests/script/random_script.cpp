// SPDX-License-Identifier: Apache-2.0
// A grammar of scripts, sampled.
#include "script/random_script.h"

#include <random>
#include <vector>

namespace photonloupe::script::tests {
namespace {

class ScriptWriter {
public:
    explicit ScriptWriter(std::uint32_t seed) : m_engine(seed) {}

    std::string write() {
        line("u0 = " + number() + "; u1 = " + number() + "; float fa[4]; int ia[5];");
        line("sum = 0; count = 0; low = 9999; high = -9999.0; best = -9999; who = -1; total = 0.0; held = 0;");
        for (std::uint32_t i = 0, n = 1 + pick(3); i < n; ++i) {
            write_uniform_statement(2);
            write_photon_loop();
        }
        line("r0 = " + expression(2) + "; r1 = sum + total + low + high + best + who + count;");
        if (pick(3) == 0)
            line("print(\"r\", r0, r1);");
        write_functions();
        return m_text;
    }

private:
    std::uint32_t pick(std::uint32_t count) { return std::uint32_t(m_engine() % count); }
    template <class... T>
    std::string any(T... choices) {
        const std::string list[] = {choices...};
        return list[pick(sizeof...(choices))];
    }
    void line(const std::string& text) { m_text += std::string(m_indent, ' ') + text + '\n'; }
    std::string number() { return std::to_string(int(pick(41)) - 20); }

    // In a photon loop `i` is the photon and `x`, `y`, `v` are set; outside only what the script begins with.
    std::string leaf() {
        if (!m_is_in_loop)
            return any(std::string("u0"), std::string("u1"), number(), std::string("fa[") + index(4) + "]",
                       std::string("getNumPhotons()"), std::string("ia[" + index(5) + "]"));
        return any(std::string("u0"), number(), std::string("x"), std::string("y"), std::string("v"),
                   std::string("i % 40"), std::string("getPhotonPosition(i, " + any("X", "Y", "Z") + ")"),
                   std::string("getNumPathVertices(i)"),
                   std::string("getPathInteraction(i, " + std::to_string(pick(4)) + ")"), std::string("u1"));
    }
    std::string index(std::uint32_t size) { return std::to_string(pick(size)); }
    std::string whole_index(std::uint32_t size) {
        return m_is_in_loop ? "abs(int(" + expression(1) + ")) % " + std::to_string(size) : index(size);
    }

    // Stays small: products are taken modulo something.
    std::string expression(int depth) {
        if (depth == 0)
            return leaf();
        const std::string a = expression(depth - 1), b = expression(int(pick(std::uint32_t(depth))));
        switch (pick(12)) {
        case 0:
            return "(" + a + " + " + b + ")";
        case 1:
            return "(" + a + " - " + b + ")";
        case 2:
            return "(" + a + " * " + b + " % " + any("7", "13", "29") + ")";
        case 3:
            return "(" + a + any(" < ", " > ", " == ", " <= ", " != ") + b + ")";
        case 4:
            return "(" + a + " > " + b + " ? " + b + " : " + expression(depth - 1) + ")";
        case 5:
            return any("min(", "max(") + a + ", " + b + ")";
        case 6:
            return any("abs(", "sign(", "floor(", "-(", "!(") + a + ")";
        case 7:
            return "(" + a + any(" && ", " || ") + b + ")";
        case 8:
            return any("f(", "g(") + a + ", " + b + ")";
        case 9:
            return "clamp(" + a + ", -50, 50)";
        default:
            return leaf();
        }
    }

    void write_block(const std::string& head, int depth) {
        line(head + " {");
        m_indent += 4;
        for (std::uint32_t i = 0, n = 1 + pick(3); i < n; ++i)
            m_is_in_loop ? write_loop_statement(depth - 1) : write_uniform_statement(depth - 1);
        m_indent -= 4;
        line("}");
    }

    void write_loop(std::uint32_t turns, int depth) {
        const std::string variable = "j" + std::to_string(m_indent); // not that of a loop around it
        write_block("for (" + any("", "int ") + variable + " = 0; " + variable + " < " + std::to_string(turns) + "; " +
                        variable + "++)",
                    depth);
    }

    void write_uniform_statement(int depth) {
        switch (depth > 0 ? pick(8) : pick(4)) {
        case 0:
            return line("u0 = " + expression(2) + " % 1000;");
        case 1:
            return line("u1" + any(" += ", " -= ", " = ") + expression(1) + "; u1 %= 100;");
        case 2:
            return line("fa[" + index(4) + "] = " + expression(2) + " % 1000;");
        case 3:
            return line("ia[" + index(5) + "] += " + any("1", "2", "u1 > 0") + ";");
        case 4:
            return write_block("if (" + expression(1) + ")", depth);
        case 5:
            return write_loop(1 + pick(4), depth);
        case 6:
            line("w = 0;");
            return line("while (w < " + std::to_string(pick(5)) + ") w++;");
        default:
            return write_photon_loop();
        }
    }

    void write_photon_loop() {
        if (m_is_in_loop)
            return;
        m_is_in_loop = true;
        line(any("for (i = 0; i < getNumPhotons(); i++) {", "for (i = 0; i <= getNumPhotons() - 1; ++i) {"));
        m_indent += 4;
        line("x = " + any("getPhotonPosition(i, X)", "i % 7", "i % 9 - 4") + "; y = getPhotonPosition(i, Y); v = 0;");
        for (std::uint32_t i = 0, n = 2 + pick(6); i < n; ++i)
            write_loop_statement(2);
        m_indent -= 4;
        line("}");
        m_is_in_loop = false;
    }

    void write_loop_statement(int depth) {
        switch (depth > 0 ? pick(18) : pick(13)) {
        case 0:
            return line("x = " + expression(2) + " % 50;");
        case 1:
            return line("v" + any(" += ", " -= ", " = ") + expression(1) + "; v %= 100;");
        case 2:
            return line("sum" + any(" += ", " -= ") + "int(" + expression(1) + ");");
        case 3:
            return line(any("count++;", "++count;", "count += 1;", "count--;"));
        case 4:
            return line("total = " + any("total + ", "total - ") + expression(1) + ";");
        case 5:
            return line("low = " + (pick(2) ? "min(low, " + expression(1) : "min(" + expression(1) + ", low") + ");");
        case 6:
            return line("high = max(high, " + expression(1) + ");");
        case 7:
            line("e = " + expression(2) + ";");
            return line("if (e > best) { best = e; who = i; }");
        case 8:
            return line("ia[" + whole_index(5) + "]" + any("++;", " += i % 3;", "--;"));
        case 9:
            return line("fa[" + whole_index(4) + "] += " + expression(1) + ";");
        case 10:
            return line("setPhotonColourEncoding(i, " + expression(1) + ", x, y);");
        case 11:
            return line("histogram(\"h\", " + expression(1) + ", -20, 20, 8);");
        case 12:
            return pick(4) == 0 ? line("held = held * 2 % 97 + " + expression(1) + "; held %= 50;")
                                : line("t = " + expression(1) + "; v += t % 10;");
        case 13:
            return write_block("if (" + expression(1) + ")", depth);
        case 14:
            return write_loop(1 + pick(3), depth);
        case 15:
            return line("if (" + expression(1) + " > 15) continue;");
        case 16:
            line("n = 0;");
            return line("while (n < x % 6) { n++; v += n; }");
        default:
            line("nn = getKNN(i, 3);");
            return line("for (q = 0; q < length(nn); q++) v += nn[q];");
        }
    }

    void write_functions() {
        m_is_in_loop = false;
        line("function f(a, b) { s = a; for (m = 0; m < 3; m++) { if (s > b) return s - b; s += m; } return s; }");
        line("function g(a, b) { float c[3]; c[0] = a; c[2] = b; c[1] = " + any("a - b", "a > b ? a : b", "u0") +
             "; return min(c[1], c[0]) - c[2]; }");
    }

    std::mt19937 m_engine;
    std::string m_text;
    std::size_t m_indent = 0;
    bool m_is_in_loop = false;
};

} // namespace

std::string write_random_script(std::uint32_t seed) {
    return ScriptWriter(seed).write();
}

} // namespace photonloupe::script::tests
