// SPDX-License-Identifier: Apache-2.0
// Arithmetic as scripts have it (engine/script/reference_math.h): NaN spreads, integers wrap, nothing is undefined.
#include "shared/script_random.h"

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

float script_min(float x, float y) {
    float least = x < y || (x == y && floatBitsToUint(x) == 0x80000000u) ? x : y;
    return is_nan(x) || is_nan(y) ? NAN : least;
}
int script_min(int x, int y) { return min(x, y); }

float script_max(float x, float y) {
    float most = x > y || (x == y && floatBitsToUint(y) == 0x80000000u) ? x : y;
    return is_nan(x) || is_nan(y) ? NAN : most;
}
int script_max(int x, int y) { return max(x, y); }

float script_clamp(float x, float lo, float hi) { return script_min(script_max(x, lo), hi); }
int script_clamp(int x, int lo, int hi) { return min(max(x, lo), hi); }

float script_abs(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0x7fffffffu); }
int script_abs(int x) { return x < 0 ? -x : x; }

float script_sign(float x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; }
int script_sign(int x) { return sign(x); }

float script_fract(float x) { precise float rest = x - floor(x); return rest; }

float script_mod(float x, float y) { precise float rest = x - y * floor(x / y); return rest; }

// C's remainder has the sign of x; by 0 it is 0.
int find_remainder(int x, int y) {
    int rest = int(uint(abs(x)) % (y == 0 ? 1u : uint(abs(y))));
    return x < 0 ? -rest : rest;
}
int script_mod(int x, int y) {
    int rest = find_remainder(x, y);
    return rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}
int script_mod(int x, int y, uint by_zero) {
    fault_if(y == 0, by_zero);
    return script_mod(x, y);
}

// The operator %.
int script_remainder(int x, int y, uint by_zero) {
    fault_if(y == 0, by_zero);
    return find_remainder(x, y);
}
float script_remainder(float x, float y, uint by_zero) {
    fault_if(y == 0.0, by_zero);
    precise float rest = x - y * trunc(x / y);
    rest = abs(y) == INFINITY && is_finite(x) ? x : rest;
    return y == 0.0 ? 0.0 : rest;
}

// A whole float as an integer; what does not fit is the nearest there is, NaN is 0.
int to_integer(float x, uint does_not_fit) {
    bool fits = x >= -2147483648.0 && x < 2147483648.0;
    fault_if(!fits, does_not_fit);
    int nearest = x > 0.0 ? 0x7fffffff : x < 0.0 ? int(0x80000000u) : 0;
    return fits ? int(x) : nearest;
}
int script_int(float x, uint does_not_fit) { return to_integer(x, does_not_fit); }
int script_floor(float x, uint does_not_fit) { return to_integer(floor(x), does_not_fit); }
int script_ceil(float x, uint does_not_fit) { return to_integer(ceil(x), does_not_fit); }

// Halves away from zero.
int script_round(float x, uint does_not_fit) {
    precise float whole = trunc(x);
    precise float rest = x - whole;
    return to_integer(abs(rest) >= 0.5 ? whole + sign(x) : whole, does_not_fit);
}

float script_mix(float a, float b, float t) { precise float between = a * (1.0 - t) + b * t; return between; }

float script_step(float edge, float x) { return is_nan(edge) || is_nan(x) ? NAN : x < edge ? 0.0 : 1.0; }

float script_smoothstep(float lo, float hi, float x) {
    precise float t = script_clamp((x - lo) / (hi - lo), 0.0, 1.0);
    precise float smooth_t = t * t * (3.0 - 2.0 * t);
    return smooth_t;
}

float script_sqrt(float x) { return x < 0.0 ? NAN : sqrt(x); }

// Whether a product is a 32-bit integer, and that product, wrapped.
bool multiply_fits(int x, int y, out int product) {
    int high;
    imulExtended(x, y, high, product);
    return high == product >> 31;
}

// x to a whole power from 0 on; beyond 32 bits the nearest integer.
int script_pow(int x, int y, uint does_not_fit) {
    if (x >= -1 && x <= 1) return y == 0 || (x == -1 && (y & 1) == 0) ? 1 : x;
    bool fits = y < 32, square_fits = true;
    int power = 1, square = x;
    for (int bits = y & 31; bits != 0; bits >>= 1) {
        if ((bits & 1) != 0) fits = multiply_fits(power, square, power) && square_fits && fits;
        square_fits = multiply_fits(square, square, square) && square_fits;
    }
    turns += 5u;
    fault_if(!fits, does_not_fit);
    return fits ? power : x < 0 && (y & 1) != 0 ? int(0x80000000u) : 0x7fffffff;
}

// The length of a vector: squares of numbers in this range neither overflow nor lose bits, others are scaled.
float find_scale(float largest) {
    if (largest < 8.8817841970012523e-16) return 1.8446744073709552e19;
    return largest > 1.125899906842624e15 ? 5.4210108624275222e-20 : 1.0;
}
// Powers of two: multiplying by one divides by the other.
float find_unscale(float scale) {
    return scale > 1.0 ? 5.4210108624275222e-20 : scale < 1.0 ? 1.8446744073709552e19 : 1.0;
}
float script_magnitude(float x, float y) {
    float scale = find_scale(max(abs(x), abs(y)));
    precise float u = x * scale, v = y * scale;
    precise float sum = u * u + v * v;
    return sqrt(sum) * find_unscale(scale);
}
float script_magnitude(float x, float y, float z) {
    float scale = find_scale(max(max(abs(x), abs(y)), abs(z)));
    precise float u = x * scale, v = y * scale, w = z * scale;
    precise float sum = u * u + v * v + w * w;
    return sqrt(sum) * find_unscale(scale);
}

float script_dot(float x0, float y0, float x1, float y1) { precise float sum = x0 * x1 + y0 * y1; return sum; }
float script_dot(float x0, float y0, float z0, float x1, float y1, float z1) {
    precise float sum = x0 * x1 + y0 * y1 + z0 * z1;
    return sum;
}

float script_random(int index, int salt) { return draw_script_random(settings.seed, uint(index), uint(salt)); }
