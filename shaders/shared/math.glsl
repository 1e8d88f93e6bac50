// SPDX-License-Identifier: Apache-2.0
// Our own elementary functions, because drivers' are off by up to 4e-4: each states its error, which the tests measure.

// The classic pair of polynomials on [-π/4, π/4] (Cephes sinf/cosf): error below 1 ulp of 1.
void sin_cos_core(float x, out float s, out float c) {
    precise float z = x * x;
    precise float sine = ((-1.9515295891e-4 * z + 8.3321608736e-3) * z - 1.6666654611e-1) * z * x + x;
    precise float cosine = ((2.443315711809948e-5 * z - 1.388731625493765e-3) * z + 4.166664568298827e-2) * z * z - 0.5 * z + 1.0;
    s = sine;
    c = cosine;
}

// After a three-part Cody-Waite reduction. Error below 2 ulp of 1 for |x| ≤ 8192.
void sin_cos(float x, out float s, out float c) {
    precise float n = round(x * 0.63661977236758134308);
    precise float r = x - n * 1.5703125;
    r = r - n * 4.837512969970703125e-4;
    r = r - n * 7.54978995489188216e-8;
    float sine, cosine;
    sin_cos_core(r, sine, cosine);
    uint quadrant = uint(int(n)) & 3u;
    s = (quadrant & 1u) == 0u ? sine : cosine;
    c = (quadrant & 1u) == 0u ? cosine : sine;
    if (quadrant == 1u || quadrant == 2u) c = -c;
    if (quadrant >= 2u) s = -s;
}

// Sine and cosine of a turn given as a 32-bit fraction: nothing is lost in the reduction, and turned by quarters the
// results turn exactly. Error below 1 ulp of 1.
void sin_cos_turn(uint turn, out float s, out float c) {
    uint shifted = turn + 0x20000000u; // quadrants from -π/4 on
    float sine, cosine;
    sin_cos_core(float(int(shifted & 0x3fffffffu) - 0x20000000) * (2.0 * PI / 4294967296.0), sine, cosine);
    bool is_odd = (shifted & 0x40000000u) != 0u;
    s = uintBitsToFloat(floatBitsToUint(is_odd ? cosine : sine) ^ (shifted & 0x80000000u));
    c = uintBitsToFloat(floatBitsToUint(is_odd ? sine : cosine) ^ ((shifted + 0x40000000u) & 0x80000000u));
}

// asin on [0, 0.5] (Cephes asinf): error below 2 ulp.
float asin_core(float x) {
    precise float z = x * x;
    return ((((4.2163199048e-2 * z + 2.4181311049e-2) * z + 4.5470025998e-2) * z + 7.4953002686e-2) * z + 1.6666752422e-1) * z * x + x;
}

// acos(x) for |x| ≤ 1, NaN beyond. Error below 4 ulp of the result.
float acos_exact(float x) {
    float a = abs(x);
    bool is_steep = a > 0.5; // there by the half angle: one polynomial serves both
    float s = asin_core(is_steep ? sqrt(0.5 * (1.0 - a)) : a);
    float half_angle = 2.0 * s;
    float steep = x < 0.0 ? PI - half_angle : half_angle;
    float flat_part = 1.57079632679489661923 - (x < 0.0 ? -s : s);
    return !(a <= 1.0) ? uintBitsToFloat(0x7fc00000u) : is_steep ? steep : flat_part;
}

// e^x (Cephes expf): error below 2 ulp, 0 below -104, inf above 88.8.
float exp_exact(float x) {
    if (!(x == x)) return x;
    if (x > 88.8) return INFINITY;
    if (x < -104.0) return 0.0;
    precise float n = floor(1.44269504088896341 * x + 0.5);
    precise float r = x - n * 0.693359375;
    r = r - n * -2.12194440e-4;
    precise float z = r * r;
    precise float p = (((((1.9875691500e-4 * r + 1.3981999507e-3) * r + 8.3334519073e-3) * r + 4.1665795894e-2) * r + 1.6666665459e-1) * r + 5.0000001201e-1) * z + r + 1.0;
    // Two factors, so that results in the denormal range are still reached.
    int whole = int(n);
    int half_power = whole / 2;
    return p * uintBitsToFloat(uint(half_power + 127) << 23) * uintBitsToFloat(uint(whole - half_power + 127) << 23);
}

// A positive finite number as m · 2^e with m in [√½, √2).
float split_exponent(float x, out float e) {
    bool is_denormal = x < 1.17549435e-38;
    uint bits = floatBitsToUint(is_denormal ? x * 16777216.0 : x);
    int exponent = int(bits >> 23u) - 126 - (is_denormal ? 24 : 0);
    float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f000000u);
    bool is_low = m < 0.70710678118654752440;
    e = float(is_low ? exponent - 1 : exponent);
    return is_low ? 2.0 * m : m;
}

// ln x of a positive finite number (Cephes logf): error below 2 ulp.
float log_exact(float x) {
    float e;
    float m = split_exponent(x, e);
    precise float r = m - 1.0;
    precise float z = r * r;
    precise float tail = (((7.0376836292e-2 * r - 1.1514610310e-1) * r + 1.1676998740e-1) * r - 1.2420140846e-1) * r;
    tail = (((tail + 1.4249322787e-1) * r - 1.6668057665e-1) * r + 2.0000714765e-1) * r - 2.4999993993e-1;
    tail = (tail * r + 3.3333331174e-1) * r * z;
    tail = tail + e * -2.12194440e-4;
    tail = tail - 0.5 * z;
    precise float result = r + tail;
    return result + e * 0.693359375;
}

// Unit vector without under- or overflow: the largest component is scaled to 1 first. Error below 2 ulp of 1.
// Zero stays zero; what is not finite becomes NaN.
vec3 normalize_safely(vec3 v) {
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (largest == 0.0) return v; // or what max() made of a NaN
    vec3 w = v / largest;
    return w / sqrt(dot(w, w));
}

// A unit vector in 30 bits (octahedral, 15 bits an axis); never 0, and never the bits of a NaN.
uint pack_normal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    uvec2 code = uvec2(clamp((n.z < 0.0 ? folded : p) * 0.5 + 0.5, 0.0, 1.0) * 32766.0 + 1.5);
    return code.x << 15u | code.y;
}

vec3 unpack_normal(uint bits) {
    vec2 p = (vec2(bits >> 15u, bits & 0x7fffu) - 1.0) / 32766.0 * 2.0 - 1.0;
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    vec2 folded = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize_safely(n.z < 0.0 ? vec3(folded, n.z) : n);
}

float square(float x) { return x * x; }

// Orthonormal basis around a unit vector (Duff et al. 2017).
void build_basis(vec3 n, out vec3 u, out vec3 v) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    u = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    v = vec3(b, s + n.y * n.y * a, -n.y);
}

// Cosine-weighted direction about the unit normal n.
vec3 sample_cosine(vec3 n, float u1, float u2) {
    float s, c;
    sin_cos(2.0 * PI * u2, s, c);
    float radius = sqrt(u1);
    vec3 u, v;
    build_basis(n, u, v);
    return normalize_safely(radius * c * u + radius * s * v + sqrt(max(0.0, 1.0 - u1)) * n);
}
