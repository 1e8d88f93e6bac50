// SPDX-License-Identifier: Apache-2.0
// Elementary functions over the whole range of floats; each states its error, measured by tests/script/math_test.cpp.
// Include after shared/math.glsl.

const float HALF_PI = 1.57079632679489661923;
const float ARC_TOLERANCE = 1e-5; // an overshoot beyond ±1 that acos and asin forgive

// 2/π after the point, 32 bits a word, behind one word of zeros.
const uint TWO_OVER_PI[8] =
    uint[8](0u, 0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u, 0xdb629599u, 0x3c439041u, 0xfe5163abu);

// A positive finite number as an angle within ±π/4 and a count of quarter turns, modulo 4 (Payne and Hanek 1983):
// only those bits of 2/π are multiplied that neither vanish nor are whole turns. Error below 2 ulp of the angle.
float reduce_quarters(float x, out uint quarter) {
    uint bits = floatBitsToUint(x);
    uint mantissa = (bits & 0x7fffffu) | 0x800000u;
    uint skip = max(bits >> 23u, 126u) - 120u; // first bit of the table that counts; x = mantissa · 2^(exponent - 150)
    uint from = skip >> 5u, by = skip & 31u;
    uint w0 = TWO_OVER_PI[0], w1 = TWO_OVER_PI[1], w2 = TWO_OVER_PI[2], w3 = TWO_OVER_PI[3];
    for (uint i = 1u; i < 5u; ++i) {
        bool is_here = from == i;
        w0 = is_here ? TWO_OVER_PI[i] : w0;
        w1 = is_here ? TWO_OVER_PI[i + 1u] : w1;
        w2 = is_here ? TWO_OVER_PI[i + 2u] : w2;
        w3 = is_here ? TWO_OVER_PI[min(i + 3u, 7u)] : w3;
    }
    uint a0 = by == 0u ? w0 : w0 << by | w1 >> 32u - by;
    uint a1 = by == 0u ? w1 : w1 << by | w2 >> 32u - by;
    uint a2 = by == 0u ? w2 : w2 << by | w3 >> 32u - by;
    uint high1, low1, high2, low2, carry;
    umulExtended(mantissa, a1, high1, low1);
    umulExtended(mantissa, a2, high2, low2);
    uint low = uaddCarry(low1, high2, carry);
    uint high = mantissa * a0 + high1 + carry; // with `low` a 64-bit fraction of a whole turn
    quarter = (high + 0x20000000u) >> 30u;
    high -= quarter << 30u;
    bool is_negative = (high & 0x80000000u) != 0u;
    high = is_negative ? ~high : high;
    low = is_negative ? ~low : low;
    precise float turn = float(high) * 2.3283064365386963e-10 + float(low) * 5.4210108624275222e-20;
    precise float angle = turn * 6.28318530717958647692;
    return is_negative ? -angle : angle;
}

// Sine and cosine of any float; NaN of what is not finite. Error below 3 ulp of each result.
void sin_cos_any(float x, out float s, out float c) {
    float size = script_abs(x);
    uint quarter;
    float reduced = reduce_quarters(size, quarter);
    bool is_small = size <= 0.785398;
    float sine, cosine;
    sin_cos_core(is_small ? size : reduced, sine, cosine);
    quarter = is_small ? 0u : quarter;
    bool is_odd = (quarter & 1u) != 0u, is_good = is_finite(x);
    s = is_odd ? cosine : sine;
    c = is_odd ? sine : cosine;
    uint sign_bit = floatBitsToUint(x) & 0x80000000u;
    s = is_good ? uintBitsToFloat(floatBitsToUint(s) ^ (quarter >= 2u ? 0x80000000u : 0u) ^ sign_bit) : NAN;
    c = is_good ? (quarter == 1u || quarter == 2u ? -c : c) : NAN;
}

// Error below 3 ulp.
float script_sin(float x) {
    float s, c;
    sin_cos_any(x, s, c);
    return s;
}

// Error below 3 ulp.
float script_cos(float x) {
    float s, c;
    sin_cos_any(x, s, c);
    return c;
}

// Error below 6 ulp.
float script_tan(float x) {
    float s, c;
    sin_cos_any(x, s, c);
    return s / c;
}

float forgive_overshoot(float x) { return abs(x) <= 1.0 + ARC_TOLERANCE ? min(max(x, -1.0), 1.0) : NAN; }

// Error below 4 ulp.
float script_acos(float x) { return acos_exact(forgive_overshoot(x)); }

// Error below 3 ulp.
float script_asin(float x) {
    float size = abs(forgive_overshoot(x));
    bool is_small = size <= 0.5;
    float core = asin_core(is_small ? size : sqrt(0.5 * (1.0 - size)));
    float angle = is_small ? core : HALF_PI - 2.0 * core;
    return size <= 1.0 ? uintBitsToFloat(floatBitsToUint(angle) | (floatBitsToUint(x) & 0x80000000u)) : NAN;
}

// Arc tangent of a positive number or inf (Cephes atanf): error below 3 ulp.
float atan_positive(float x) {
    bool is_large = x > 2.414213562373095, is_middle = x > 0.4142135623730950;
    float reduced = is_large ? -1.0 / x : is_middle ? (x - 1.0) / (x + 1.0) : x;
    float base = is_large ? HALF_PI : is_middle ? 0.785398163397448309616 : 0.0;
    precise float z = reduced * reduced;
    precise float tail =
        (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * reduced;
    precise float angle = base + (tail + reduced);
    return angle;
}

// Error below 3 ulp.
float script_atan(float x) {
    float angle = atan_positive(script_abs(x));
    angle = uintBitsToFloat(floatBitsToUint(angle) | (floatBitsToUint(x) & 0x80000000u));
    return is_nan(x) ? x : angle;
}

// The angle of (x, y), signed zeros and infinities as in C. Error below 4 ulp.
float script_atan2(float y, float x) {
    float height = script_abs(y), width = script_abs(x);
    bool is_square = height == width; // 0 by 0, inf by inf
    float ratio = is_square ? (height == 0.0 ? 0.0 : 1.0) : height / width;
    float angle = atan_positive(ratio);
    angle = (floatBitsToUint(x) & 0x80000000u) != 0u ? PI - angle : angle;
    angle = uintBitsToFloat(floatBitsToUint(angle) | (floatBitsToUint(y) & 0x80000000u));
    return is_nan(x) || is_nan(y) ? NAN : angle;
}

float special_log(float x, float result) {
    result = x == INFINITY ? INFINITY : result;
    result = x == 0.0 ? -INFINITY : result;
    return x >= 0.0 ? result : NAN;
}

float script_log(float x) { return special_log(x, log_exact(x)); }

float script_exp(float x) { return exp_exact(x); }

// a + b and a · b without loss, as a rounded value and what it lacks (Dekker 1971).
vec2 add_exactly(float a, float b) {
    precise float sum = a + b;
    precise float back = sum - a;
    precise float rest = (a - (sum - back)) + (b - back);
    return vec2(sum, rest);
}
vec2 split_halves(float a) {
    precise float scaled = a * 4097.0;
    precise float high = scaled - (scaled - a);
    precise float low = a - high;
    return vec2(high, low);
}
vec2 multiply_exactly(float a, float b) {
    precise float product = a * b;
    vec2 u = split_halves(a), v = split_halves(b);
    precise float rest = ((u.x * v.x - product) + u.x * v.y + u.y * v.x) + u.y * v.y;
    return vec2(product, rest);
}

// The logarithm of a positive finite number as a sum of two floats, to about 2^-34 of itself.
vec2 log_in_two(float x) {
    float e;
    float m = split_exponent(x, e);
    vec2 above = add_exactly(m, -1.0), below = add_exactly(m, 1.0);
    precise float s = above.x / below.x; // log m = 2 artanh s
    vec2 product = multiply_exactly(s, below.x);
    precise float s_rest = (((above.x - product.x) - product.y) - s * below.y) / below.x;
    vec2 square = multiply_exactly(s, s);
    square.y = square.y + 2.0 * s * s_rest;
    precise float z = square.x;
    precise float series = ((((0.1818181818 * z + 0.2222222222) * z + 0.2857142857) * z + 0.4) * z);
    vec2 third = add_exactly(0.66666668653488159, series); // 2/3 + …
    third.y = third.y - 1.9868214962e-8;
    vec2 cube = multiply_exactly(s, z);
    cube.y = cube.y + s * square.y + s_rest * z;
    vec2 tail = multiply_exactly(cube.x, third.x);
    tail.y = tail.y + cube.x * third.y + cube.y * third.x;
    vec2 sum = add_exactly(2.0 * s, tail.x);
    sum.y = sum.y + (tail.y + 2.0 * s_rest);
    vec2 whole = add_exactly(e * 0.693359375, sum.x); // 0.693359375 has 9 bits: exact
    precise float rest = whole.y + (sum.y + e * -2.12194440e-4);
    return add_exactly(whole.x, rest);
}

// x to the power y for positive finite x and finite y. Error below 2 ulp, where the result is not denormal.
float pow_positive(float x, float y) {
    y = clamp(y, -1e30, 1e30); // beyond, splitting overflows; the result is 0, 1 or inf there
    vec2 logarithm = log_in_two(x);
    precise float power = y * logarithm.x;
    if (!(abs(power) < 200.0)) return power > 0.0 ? INFINITY : 0.0;
    vec2 product = multiply_exactly(y, logarithm.x);
    precise float rest = product.y + y * logarithm.y;
    float result = exp_exact(product.x);
    precise float corrected = result + result * rest;
    return result == INFINITY || result == 0.0 ? result : corrected;
}

// As C's pow, but any NaN gives NaN. Error below 3 ulp.
float script_pow(float x, float y) {
    float size = script_abs(x);
    bool is_whole = y == floor(y), is_odd = is_whole && abs(y) < 16777216.0 && (int(y) & 1) != 0;
    bool is_large = size > 1.0;
    float result = pow_positive(is_finite(size) && size > 0.0 ? size : 1.0, is_finite(y) ? y : 0.0);
    if (size == 0.0 || size == INFINITY) result = (size == 0.0) == (y < 0.0) ? INFINITY : 0.0;
    if (abs(y) == INFINITY) result = size == 1.0 ? 1.0 : is_large == (y > 0.0) ? INFINITY : 0.0;
    if (y == 0.0) result = 1.0;
    bool is_negative = (floatBitsToUint(x) & 0x80000000u) != 0u;
    result = is_negative && is_odd ? -result : result;
    if (x < 0.0 && is_finite(x) && !is_whole && abs(y) < INFINITY) result = NAN;
    return is_nan(x) || is_nan(y) ? NAN : result;
}

// ½ + ½ cos(angle − 2π channel / 3), [SJL15] section 4.2. The angle's sine and cosine serve all three channels, whose
// own are known to the compiler. Error below 4 ulp of 1.
float script_hue(float angle, float channel) {
    float s, c, channel_s, channel_c;
    sin_cos_any(angle, s, c);
    precise float turn = 2.09439510239319549231 * channel;
    sin_cos_any(turn, channel_s, channel_c);
    precise float shade = 0.5 + 0.5 * (c * channel_c + s * channel_s);
    return shade;
}
