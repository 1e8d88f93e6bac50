// SPDX-License-Identifier: Apache-2.0
// Points on area lights. Inputs: emitting. Defines: HAS_COLORED_LAMPS.
#pragma binding texel emitting

struct EmittingPoint {
    vec3 position;
    vec3 normal; // unit, of the front
    float error; // metres: bound on the rounding of the position
    vec3 tint;   // of the light's mean
};

// By power over the triangles first … first + count - 1: `choice` says which one, u in [0, 1)² where on it.
EmittingPoint sample_emitting(uint first, uint count, float choice, vec2 u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) { // the first whose cumulative share is above `choice`
        uint middle = (low + high) / 2u;
        if (choice < emitting_at(EMITTING_TEXELS * (first + middle)).w) high = middle;
        else low = middle + 1u;
    }
    uint texel = EMITTING_TEXELS * (first + low);
    vec4 v0 = emitting_at(texel);
    vec3 v1 = emitting_at(texel + 1u).xyz;
    vec3 v2 = emitting_at(texel + 2u).xyz;
    float root = sqrt(u.x);
    vec3 weights = vec3(1.0 - root, root * (1.0 - u.y), root * u.y);
    EmittingPoint point;
    point.tint = vec3(1.0);
#ifdef HAS_COLORED_LAMPS
    point.tint = emitting_at(texel + 3u).rgb;
#endif
    point.position = weights.x * v0.xyz + weights.y * v1 + weights.z * v2;
    vec3 reach = max(abs(v0.xyz), max(abs(v1), abs(v2)));
    point.error = POSITION_ERROR * max(reach.x, max(reach.y, reach.z));
    vec3 e1 = v1 - v0.xyz;
    vec3 e2 = v2 - v0.xyz;
    float s1 = max(abs(e1.x), max(abs(e1.y), abs(e1.z)));
    float s2 = max(abs(e2.x), max(abs(e2.y), abs(e2.z)));
    point.normal = normalize_safely(cross(e1 / s1, e2 / s2));
    return point;
}
