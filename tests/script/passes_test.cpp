// SPDX-License-Identifier: Apache-2.0
// Passes on the device against the interpreter, feature by feature.
#include <gtest/gtest.h>

#include "script/run_on_device.h"

namespace photonloupe::script::tests {
namespace {

// Two whole blocks and a part of one.
constexpr std::uint32_t COUNT = 2 * 4096 + 807;

const HostPhotons& get_photons() {
    static const HostPhotons photons = make_random_photons(COUNT);
    return photons;
}

// A body in a loop over all photons; it sets parameter 3 to `v` and parameter 4 to `w`.
std::string loop(const std::string& body, const std::string& before = "", const std::string& after = "") {
    return "declarePhotonParameter(3, 0, 1); declarePhotonParameter(4, 0, 1);\nn = getNumPhotons();\n" + before +
           "\nfor (i = 0; i < n; i++) {\n v = 0; w = 0;\n" + body +
           "\n setPhotonParameter(i, 3, v); setPhotonParameter(i, 4, w);\n}\n" + after;
}

TEST(Passes, columns_are_read_as_by_the_interpreter) {
    expect_same(loop("v = getPhotonPosition(i, X) + 2 * getPhotonPosition(i, Y) - getPhotonPosition(i, Z);"
                     "w = getPhotonNormal(i, 2) * getPhotonPower(i, 1) + getPhotonEmitter(i);"),
                get_photons());
    expect_same(loop("a = i % 3; v = getPhotonPosition(i, a) * getPhotonPower(n - 1 - i, a) + getPhotonNormal(i / "
                     "2, a);"
                     "w = getPhotonParameter(i, a) + getPhotonEmitter(n - 1 - i);"),
                get_photons());
}

TEST(Passes, paths_are_read_as_by_the_interpreter) {
    expect_same(loop(R"(
  m = getNumPathVertices(i);
  for (j = 0; j < m; j++) {
    v += getPathVertex(i, j, X) * getPathNormal(i, j, j % 3) + getPathScatter(i, j);
    w += getPathInteraction(i, j) * 10 + getPathObject(i, j);
  }
  o = (i * 7) % n;
  v += getPathVertex(o, getNumPathVertices(o) - 1, Y) + getPathInteraction(o, 1) + getPathObject(o, 0)
    + getPathNormal(o, 1, Z);)"),
                get_photons());
}

TEST(Passes, what_is_out_of_range_is_reported_alike) {
    expect_same(loop(R"(
  float c[4];
  c[i % 6] = 2; v = c[i % 5] + getPathVertex(i, i % 9, X) + getPhotonPower(i - 5, 1) + getPhotonNormal(i, i % 4);
  w = getPathVertex(i + 3, i % 3, i % 5) + getNumPathVertices(i * 2) + c[i * 0.25] + getPhotonPosition(i * 0.5, 0);
  w = w + getPhotonEmitter(0 - i) + getPathInteraction(i, i % 9) + 5 % (i % 3) + i * 0.5 % (i % 2);
  k = int(1e6 * (i - 40) * (i - 40)) + floor(0 / (i - 7.0)); k += int(pow(10, i % 14 + 0.5));
  v = v + k + getPhotonParameter(i, i % 7);)"),
                get_photons());
}

TEST(Passes, variables_that_may_be_unset_are_reported_alike) {
    expect_same(loop("float x; int m; if (i % 3 == 0) x = 2; if (i % 5 == 0) m = 7; v = x + u; w = m; x += 1; w += x;",
                     "if (n < 0) u = 2;"),
                get_photons());
    expect_same("declarePhotonParameter(3, 0, 1);\nfunction f(a) { if (a > 10) t = a; return t; }\n"
                "function g(a) { if (a % 2 == 0) return 3; }\n"
                "for (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, f(i) + f(i - 5) + g(i));",
                get_photons());
}

TEST(Passes, operators_are_those_of_the_interpreter) {
    expect_same(loop(R"(
  a = i - 3000; b = i * 7919; b = b * b;
  k = a / 7; m = a % 7 - b % 11 + -a % (i % 13 + 1);
  v = k * 3 - 2 / (a + 0.5) + (a < b) + (a == 0) * 2 + !(a > 5) + (a >= 2 && b != 3 || a <= -9) - -a;
  w = (a > 0 ? b : m) + (i % 2 ? 0.5 : 0.25) + b; )"),
                get_photons());
}

TEST(Passes, side_effects_happen_from_left_to_right) {
    expect_same(loop(R"(
  a = i % 5; b = a++ * 10 + a; c = ++a - a-- * (a = 3); x = (a += 2) + (a *= 3) + a;
  float q[4]; q[a % 4] = a++; q[0] += q[1] = 5; q[2]++; y = q[a % 3]++ + q[a % 3];
  d = a > 2 && (b = b + 1) > 3 || (c = c + 2) > 0; e = a++ < 100 ? (b += 3) : (c -= 2);
  z = 0; while (z++ < 4) { if (z == 2) continue; b += z; }
  for (j = 0, k = 9; (j += 1) < k--; b += 2, c++) { if (j == 2) continue; c += b; }
  do { if (z-- % 2 == 0) continue; c++; } while ((b -= 1) % 4 > 0 && z > 0);
  v = a + b * 0.5 + c + x; w = y + d + e + z + q[0] + q[3];)"),
                get_photons());
}

TEST(Passes, control_flow_is_that_of_the_interpreter) {
    expect_same(loop(R"(
  if (i % 7 == 3) continue;
  if (i % 2 == 0) { v = 1; } else if (i % 3 == 0) { v = 2; } else if (i % 5 == 0) v = 3; else { v = 4; }
  for (j = 0; j < 10; j++) { if (j == i % 11) break; for (k = j; k < 6; k++) { if (k % 2) continue; w += k; } }
  do { v += 2; if (v > 9) break; } while (v < 20);
  for (;;) { w++; if (w > 30) break; })"),
                get_photons());
}

TEST(Passes, functions_are_inlined_with_names_of_their_own) {
    expect_same("function norm(x, y) { s = x * x + y * y; if (s > 1) return sqrt(s); return s; }\n"
                "float twice(a) { a *= 2; t = norm(a, 1) + offset; return t; }\n"
                "function paint(p) { setPhotonColourEncoding(p, twice(p * 0.001), norm(0.1, p % 3), offset); }\n" +
                    loop("v = norm(i, 2) + twice(i) * twice(norm(1, i % 4)); paint(i); for (j = 0; j < 3; j++) w += "
                         "norm(j, i % 2);",
                         "offset = 0.25;"),
                get_photons());
}

TEST(Passes, elementary_functions_agree) {
    Comparison near{16, 1e-5};
    expect_same(loop(R"(
  x = getPhotonPosition(i, 0); y = getPhotonPower(i, 0);
  v = sin(x) + cos(y * 40) + tan(x * 0.3) + asin(y) + acos(y) + atan(x) + atan2(x, y - 0.5) + hue(x, i % 3);
  w = exp(x) + log(y + 0.01) + sqrt(y) + pow(y, x) + pow(i % 50, 3) + magnitude(x, y) + magnitude(x, y, 3);)"),
                get_photons(), near);
    expect_same(loop(R"(
  x = getPhotonPosition(i, 0); y = getPhotonPower(i, 0); k = i - 2000;
  v = abs(x) + sign(x) + fract(x) + mod(x, y) + min(x, y) + max(x, 0) + clamp(x, 0, y) + mix(x, y, 0.3) + step(0, x);
  v += smoothstep(-1, 1, x) + dot(x, y, 1, 2) + dot(x, y, 1, y, x, 3) + random(i, 3) + random(3, i);
  w = int(x * 10) + floor(x) + ceil(x) + round(x * 2) + abs(k) + sign(k) + mod(k, 7) + min(k, 3) + max(k, 4)
    + clamp(k, -5, 5)
    + x % 0.7;)"),
                get_photons());
}

TEST(Passes, reductions_give_the_interpreters_bits) {
    expect_same(loop(R"(
  p = getPhotonPower(i, 0); x = getPhotonPosition(i, 1);
  s += p; t -= x; c++; if (x > 0) d += 2;
  lo = min(lo, x); hi = max(p, hi); ilo = min(ilo, i * 77 % 1001); 
  if (p < best) { best = p; who = i; where = x; }
  if (x > most) { most = x; which = i; }
  for (j = 0; j < 3; j++) if (getPhotonPosition(i, j) < near) { near = getPhotonPosition(i, j); axis = j; }
  v = p;)",
                     "s = 10; t = 0; c = 5; d = 0; lo = 1e9; hi = -1e9; ilo = 99999; best = 1e9; who = -1; where = "
                     "0; most = 2.5; "
                     "which = -7; near = 0; axis = -1;"),
                get_photons());
}

TEST(Passes, ties_and_what_was_before_decide_a_choice_as_in_a_serial_run) {
    expect_same(loop(R"(
  e = i * 37 % 100;
  if (e < a) { a = e; ka = i; } if (e > b) { b = e; kb = i; } if (e < c) { c = e; kc = i; }
  r = 0.0 / (i % 5) + e; if (r < d) { d = r; kd = i; })",
                     "a = 50; ka = -1; b = 1000; kb = -1; c = 0; kc = -3; d = 1e9; kd = -1;"),
                get_photons());
}

TEST(Passes, array_reductions_give_the_interpreters_bits) {
    expect_same(loop(R"(
  k = i * 13 % 17; p = getPhotonPower(i, 0);
  sums[k] += p; sums[k] -= 0.25; counts[k % 8]++; counts[k] += 2; low[k] = min(low[k], p); high[k] = max(p, high[k]);
  if (p > most[k]) { most[k] = p; who[k] = i; }
  if (i < first[k % 3]) first[k % 3] = i;
  sums[i] += 1;)",
                     "float sums[17]; int counts[17]; float low[17]; float high[17]; float most[17]; int who[17]; "
                     "int first[3];\n"
                     "for (k = 0; k < 17; k++) { low[k] = 1e9; most[k] = 0.5; } first[0] = 1000000; first[1] = 5;"),
                get_photons());
}

TEST(Passes, nan_spreads_through_minimum_but_is_never_chosen) {
    expect_same(loop("x = i == 100 ? 0.0 / (i - 100) : i; a = min(a, x); b = max(b, i); if (x < c) { c = x; k = i; "
                     "} s += x;",
                     "a = 1e9; b = -0.0; c = 1e9; k = -1; s = 0;"),
                get_photons());
}

TEST(Passes, pca_agrees_to_rounding) {
    const Comparison near{64, 2e-5};
    expect_same(loop(R"(
  resetPCA2D(); resetPCA3D();
  for (j = 0; j < getNumPathVertices(i); j++) {
    pushPCA2D(getPathVertex(i, j, X), getPathVertex(i, j, Y));
    pushPCA3D(getPathVertex(i, j, X) * 3, getPathVertex(i, j, Y), getPathVertex(i, j, Z) * 0.3);
  }
  if (decomposePCA2D()) v = getPCAEigenvalue(0) + getPCAMean(1);
  if (decomposePCA3D()) w = getPCAEigenvalue(1) + getPCAEigenvalue(2) + getPCAMean(2);)"),
                get_photons(), near);
}

TEST(Passes, a_pca_of_all_photons_gives_the_interpreters_bits) {
    expect_same(loop("pushPCA3D(getPhotonPosition(i, X), getPhotonPosition(i, Y), getPhotonPosition(i, Z)); if (i % "
                     "3 == 0) "
                     "pushPCA2D(i, 2);",
                     "", R"(
a = decomposePCA3D(); e = getPCAEigenvalue(0); f = getPCAEigenvalue(2); g = getPCAEigenvector(1, 2); h = getPCAMean(0);
for (i = 0; i < n; i++) setPhotonParameter(i, 3, getPCAEigenvector(0, i % 3) + getPCAEigenvalue(i % 4) + getPCAMean(1));
)"),
                get_photons());
}

TEST(Passes, nothing_decomposed_is_reported_alike) {
    expect_same(loop("resetPCA2D(); pushPCA2D(1, i % 2); pushPCA2D(1, 0); z = decomposePCA2D(); v = "
                     "getPCAEigenvalue(0); w = "
                     "getPCAEigenvector(0, 1) + getPCAMean(i % 3);"),
                get_photons(), {8, 1e-6});
}

TEST(Passes, own_parameters_are_read_back_and_outputs_staged) {
    expect_same(loop("if (i % 2) setPhotonParameter(i, 3, i); w = getPhotonParameter(i, 3) + 1; d = 3 + i % 2; "
                     "setPhotonParameter(i, d, 7); v = getPhotonParameter(i, 4) + getPhotonParameter(i, d);"),
                get_photons());
    expect_same("declarePhotonParameter(3, 0, 1); declarePhotonParameter(4, 0, 1); n = getNumPhotons();\n"
                "for (i = 0; i < n; i++) { if (i % 3 == 1) continue; setPhotonParameter(i, 3, i * 0.5); if (i % 4 "
                "== 0) "
                "setPhotonColourEncoding(i, 1, i, 0); }\n"
                "for (i = 0; i < n; i++) setPhotonColourEncoding(i, getPhotonParameter(n - 1 - i, 3), "
                "getPhotonParameter(i, 4), 1);",
                get_photons());
}

TEST(Passes, histograms_and_prints_agree) {
    expect_same(loop("x = getPhotonPosition(i, 0); histogram(\"x\", x, -2, hi); histogram(\"k\", i, 0, 5000, 7); "
                     "histogram(\"bad\", 0.0 / (i % 2), 0, 1); histogram(\"none\", x, 2, hi - 9); if (i % 1000 == 77) "
                     "print(\"photon\", i, x);",
                     "hi = 2 + 0 * random(1, 1);"),
                get_photons());
}

TEST(Passes, neighbor_lists_agree) {
    HostPhotons photons = get_photons();
    photons.find_neighbors = [](NeighborQuery::Space space, std::uint32_t photon, std::uint32_t k, float beta) {
        std::vector<std::int32_t> found;
        const std::uint32_t shorter = (photon * 7 + std::uint32_t(beta)) % (k + 1);
        const std::uint32_t length = space == NeighborQuery::Space::world ? k : shorter;
        for (std::uint32_t i = 0; i < length; ++i)
            found.push_back(std::int32_t((photon * 31 + i * 17 + 1) % COUNT));
        return found;
    };
    expect_same(R"(
declarePhotonParameter(3, 0, 1); n = getNumPhotons(); k = 7; fixed = getKNN(5, 4);
function sum(p) { list = getKNN(p, 6); total = 0; for (q = 0; q < length(list); q++) total += list[q]; return total; }
for (i = 0; i < n; i++) {
  a = getKNN(i, k); b = getKNN(a[2], 3); c = getKNN(i, 1000);
  s = 0; for (j = 0; j < length(a); j++) s += a[j];
  setPhotonParameter(i, 3, s + sum(i) + sum(n - 1 - i) + b[1] + a[7] + fixed[i % 5] + length(c));
}
for (i = 0; i < n; i++) {
  a = getParameterKNN(i, 9); b = getConstrainedKNN(i, 11, 2.5); c = getParameterKNN(n - i, 5);
  setPhotonColourEncoding(i, length(a), length(b) > 0 ? b[length(b) - 1] : -1, c[0]);
})",
                photons);
}

TEST(Passes, photons_that_run_out_of_fuel_leave_no_trace) {
    RunSettings settings;
    settings.fuel = 500;
    settings.most_exhausted = 1'000'000;
    for (const char* body : {"x = i; while (x > 1) { x -= i % 100 == 5 ? 0.25 : i; s += 1; c[i % 4] += 1; } "
                             "histogram(\"h\", i, 0, 9); v = x;",
                             "x = i; do { x -= i % 100 == 5 ? 0.25 : i; s += 1; lo = min(lo, -x); } while (x > 1); "
                             "v = x;"})
        expect_same(loop(body, "s = 0; lo = 9; int c[4];"), get_photons(), {}, settings);
}

TEST(Passes, photons_with_more_turns_than_the_device_has_are_taken_by_the_interpreter) {
    RunSettings settings;
    settings.fuel = 90'000;
    expect_same(loop("x = 0; while (x < (i % 2000 == 77 ? 70000 : i % 2000 == 5 ? 100000 : 10)) x += 1; v = "
                     "x;"),
                get_photons(), {}, settings);
}

TEST(Passes, k_means_agrees) {
    expect_same(R"(
declarePhotonParameter(3, 0, 8); n = getNumPhotons();
float cx[6]; float cy[6]; float cz[6]; float sx[6]; float sy[6]; float sz[6]; int count[6];
for (c = 0; c < 6; c++) { cx[c] = random(c, 1) - 0.5; cy[c] = random(c, 2) - 0.5; cz[c] = random(c, 3) - 0.5; }
moved = 1; turns = 0;
while (moved > 0.01 && turns < 10) {
  for (c = 0; c < 6; c++) { sx[c] = 0; sy[c] = 0; sz[c] = 0; count[c] = 0; }
  for (i = 0; i < n; i++) {
    best = 1e30; who = 0;
    for (c = 0; c < 6; c++) {
      d = magnitude(getPhotonNormal(i, X) - cx[c], getPhotonNormal(i, Y) - cy[c], getPhotonNormal(i, Z) - cz[c]);
      if (d < best) { best = d; who = c; }
    }
    sx[who] += getPhotonNormal(i, X); sy[who] += getPhotonNormal(i, Y); sz[who] += getPhotonNormal(i, Z); count[who]++;
    setPhotonParameter(i, 3, who);
  }
  moved = 0; turns++;
  for (c = 0; c < 6; c++) if (count[c] > 0) {
    x = sx[c] / count[c]; y = sy[c] / count[c]; z = sz[c] / count[c];
    moved = max(moved, magnitude(x - cx[c], y - cy[c], z - cz[c])); cx[c] = x; cy[c] = y; cz[c] = z;
  }
})",
                get_photons());
}

} // namespace
} // namespace photonloupe::script::tests
