// SPDX-License-Identifier: Apache-2.0
// An environment that an image says: what is seen along a direction, and directions drawn in proportion to radiance
// (engine/scene/environment_map.h). Input: environment_map, texels: EnvironmentHeader, a texel for each row, then the image
// row by row, the first column towards +x; w of rows and of what is in a row: share up to and with it, as bits.
#include "shared/scene.h"
#pragma binding texel environment_map

struct EnvironmentPoint {
    vec3 direction;
    vec3 radiance;
    float largest; // channel of the radiance
};

EnvironmentHeader load_environment() {
    vec4 header = environment_map_at(0u);
    return EnvironmentHeader(floatBitsToUint(header.x), floatBitsToUint(header.y), header.z, header.w);
}

EnvironmentPoint describe_point(vec3 direction, vec3 radiance) {
    return EnvironmentPoint(direction, radiance, max(radiance.r, max(radiance.g, radiance.b)));
}

// The first of `count` shares from the texel `first` on that is above the fraction; `rest`: how far the fraction has
// come in it.
uint choose_share(uint first, uint count, uint fraction, out float rest) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (fraction < floatBitsToUint(environment_map_at(first + middle).w)) high = middle;
        else low = middle + 1u;
    }
    uint before = low == 0u ? 0u : floatBitsToUint(environment_map_at(first + low - 1u).w);
    rest = float(fraction - before) / float(max(floatBitsToUint(environment_map_at(first + low).w) - before, 1u));
    return low;
}

// The direction at a share of a row's solid angle and a share of the turn. Rows of either half are counted from their
// pole, where 1 - cos keeps its digits.
vec3 point_at(EnvironmentHeader sky, uint row, float along, float azimuth) {
    bool is_low = 2u * row >= sky.height;
    float from_pole = float(is_low ? sky.height - 1u - row : row);
    float upper, lower, unused;
    sin_cos(0.5 * PI * (from_pole / float(sky.height)), upper, unused);
    sin_cos(0.5 * PI * ((from_pole + 1.0) / float(sky.height)), lower, unused);
    float share = mix(upper * upper, lower * lower, is_low ? 1.0 - along : along); // of the sphere: (1 - cos)/2
    float y = 1.0 - 2.0 * share;
    float radius = 2.0 * sqrt(max(0.0, share * (1.0 - share)));
    float s, c;
    sin_cos(2.0 * PI * azimuth, s, c);
    return normalize_safely(vec3(radius * c, is_low ? -y : y, radius * s));
}

// Density per steradian: largest channel over the header's `whole`.
EnvironmentPoint sample_environment(EnvironmentHeader sky, uvec2 fractions) {
    float row_rest, column_rest;
    uint row = choose_share(1u, sky.height, fractions.y >> (32u - ENVIRONMENT_FRACTION_BITS), row_rest);
    uint first = 1u + sky.height + row * sky.width;
    uint column = choose_share(first, sky.width, fractions.x >> (32u - ENVIRONMENT_FRACTION_BITS), column_rest);
    float azimuth = (float(column) + column_rest) / float(sky.width) + sky.turn;
    return describe_point(point_at(sky, row, row_rest, azimuth), environment_map_at(first + column).rgb);
}

// atan(across / along) for numbers that are not negative, from whichever of the two is the smaller.
float find_steepness(float along, float across) {
    float least = min(along, across);
    float most = max(along, across);
    float angle = most > 0.0 ? acos_exact(least / sqrt(least * least + most * most)) : 0.5 * PI;
    return across > along ? angle : 0.5 * PI - angle;
}

EnvironmentPoint see_environment(EnvironmentHeader sky, vec3 direction) {
    float polar = find_steepness(abs(direction.y), sqrt(direction.x * direction.x + direction.z * direction.z));
    float azimuth = find_steepness(abs(direction.x), abs(direction.z));
    if (direction.y < 0.0) polar = PI - polar;
    if (direction.x < 0.0) azimuth = PI - azimuth;
    float turn = fract((direction.z < 0.0 ? -azimuth : azimuth) / (2.0 * PI) - sky.turn);
    uint row = min(uint(polar / PI * float(sky.height)), sky.height - 1u);
    uint column = min(uint(turn * float(sky.width)), sky.width - 1u);
    return describe_point(direction, environment_map_at(1u + sky.height + row * sky.width + column).rgb);
}
