// SPDX-License-Identifier: Apache-2.0
// Emission: from the emitted index to a light and a place inside its projection map's marked cells, which stands for a
// direction or a start (METHODS §1; engine/trace/emission_frame.h). The unit square is mapped onto the marked cells row by
// row, so that its stratification is kept.
#ifdef HAS_AREA_LIGHTS
#include "scene/emitting.glsl"
#endif
#ifdef HAS_ENVIRONMENT_MAP
#include "scene/environment.glsl"
#endif

struct Emission {
    uint light;
    vec3 origin;
    vec3 direction;
    vec3 normal; // of its surface; a light that has none: the direction
    vec3 flux; // W, times the number emitted
};

uint sample_emission(uint index, uint dimension) {
#if EMISSION == 0 // EMISSION_SOBOL
    return sample_sobol(settings.seed, index, dimension);
#else
    return random_bits(settings.seed, index, 0xffffffffu, dimension);
#endif
}

// fraction · n for a 32-bit fraction: whole part and remaining fraction, exactly.
uint scale_fraction(uint fraction, uint n, out float rest) {
    uint whole, low;
    umulExtended(fraction, n, whole, low);
    rest = to_unit_float(low);
    return whole;
}

uint choose_light(uint index) {
#ifndef HAS_SEVERAL_LIGHTS
    return 0u;
#else
    float u = to_unit_float(sample_emission(index, 2u));
    uint low = 0u;
    uint high = settings.light_count - 1u;
    while (low < high) { // the first whose cumulative probability is above u
        uint middle = (low + high) / 2u;
        if (u < emitters[middle].flux_cumulative.w) high = middle;
        else low = middle + 1u;
    }
    return low;
#endif
}

// A place on the square: columns and rows as fractions.
struct Place {
    float column, row;
};

vec3 turn_about(LightEmission light, float column, float cosine, float sine) {
    float s, c;
    sin_cos(2.0 * PI * column, s, c);
    return normalize_safely(sine * c * light.u_axis.xyz + cosine * light.axis_sides.xyz + sine * s * light.v_axis.xyz);
}

// Of x in [0, 1]: two of Newton's steps from the driver's rough one.
float find_cube_root(float x) {
    if (x < 1e-18) return 0.0;
    float root = pow(x, 1.0 / 3.0);
    for (uint i = 0u; i < 2u; ++i) root -= (root - x / (root * root)) / 3.0;
    return root;
}

// Inner cone: 1 - cos grows with the share of the power; ramp: its cube root.
void emit_spot(inout Emission emission, LightEmission light, Place place) {
    float inner = light.cone.x;
    float ramp = light.cone.y - inner;
    float beyond = place.row * (inner + ramp / 3.0); // 1 - cos
    if (beyond > inner) beyond = light.cone.y - ramp * find_cube_root(1.0 - 3.0 * (beyond - inner) / ramp);
    float sine = sqrt(max(0.0, beyond * (2.0 - beyond)));
    emission.direction = turn_about(light, place.column, 1.0 - beyond, sine);
}

#ifdef HAS_AREA_LIGHTS
// Cosine-weighted on the sides that shine.
void emit_area(inout Emission emission, LightEmission light, Place place, uint index) {
    vec2 u = vec2(to_unit_float(sample_emission(index, 3u)), to_unit_float(sample_emission(index, 4u)));
    float choice = to_unit_float(random_bits(settings.seed, index, 0xffffffffu, 5u));
    EmittingPoint point = sample_emitting(light.first_row.z, light.first_row.w, choice, u);
    bool is_back = light.axis_sides.w > 1.0 && place.row > 0.5;
    float sine2 = light.axis_sides.w > 1.0 ? 2.0 * (is_back ? 1.0 - place.row : place.row) : place.row;
    float cosine = sqrt(max(0.0, 1.0 - sine2));
    if (light.grid.x > 1u) { // aimed: one normal serves all of it
        emission.direction = turn_about(light, place.column, is_back ? -cosine : cosine, sqrt(sine2));
    } else {
        vec3 a, b;
        build_basis(point.normal, a, b);
        float s, c;
        sin_cos(2.0 * PI * place.column, s, c);
        emission.direction = normalize_safely(sqrt(sine2) * (c * a + s * b) + (is_back ? -cosine : cosine) * point.normal);
    }
    emission.normal = is_back ? -point.normal : point.normal;
    emission.origin = point.position + point.error * emission.normal;
    emission.flux *= point.tint;
}
#endif

#ifdef HAS_ENVIRONMENT_MAP
// From where the image is bright, by the square's rows and columns; its color, by its largest channel.
void face_image(inout Emission emission, uint index) {
    EnvironmentPoint from = sample_environment(load_environment(), uvec2(sample_emission(index, 0u), sample_emission(index, 1u)));
    emission.direction = -from.direction;
    emission.flux *= from.radiance / from.largest;
}
#endif

// Farther away than so many radii of the discs, places across the direction are rounded visibly.
const float FAR_START = 64.0;
// Share of the way that is added so that the start lies before what is in the way.
const float PAST_BLOCKER = 1e-3;

// On a disc across the direction, before everything. Where something lies far away, all that is specular lies in the
// discs' ball: light starts before the ball, or before what blocks the way to it, where it ends.
void start_around(inout Emission emission, LightEmission light, uint index) {
    float s, c;
    sin_cos(2.0 * PI * to_unit_float(sample_emission(index, 4u)), s, c);
    float radius = light.cone.x * sqrt(to_unit_float(sample_emission(index, 3u)));
    vec3 a, b;
    build_basis(emission.direction, a, b);
    emission.origin += radius * (c * a + s * b);
    float distance = light.cone.y;
    if (distance > FAR_START * light.cone.x) {
        vec3 near = emission.origin - light.cone.x * emission.direction;
        float blocked = find_blocker(Ray(near, -emission.direction));
        distance = light.cone.x * (1.0 + PAST_BLOCKER) + (blocked < INFINITY ? blocked * (1.0 + PAST_BLOCKER) : 0.0);
    }
    emission.origin -= distance * emission.direction;
}

// Kinds other than point lights; of those nothing but what the scene has is compiled.
void emit_otherwise(inout Emission emission, LightEmission light, Place place, uint index) {
    uint kind = floatBitsToUint(light.position_kind.w);
#ifdef HAS_SPOT_LIGHTS
    if (kind == LIGHT_SPOT) emit_spot(emission, light, place);
#endif
#ifdef HAS_DIRECTIONAL_LIGHTS
    if (kind == LIGHT_DIRECTIONAL) {
        emission.direction = light.axis_sides.xyz;
        emission.origin += place.column * light.u_axis.xyz + place.row * light.v_axis.xyz;
    }
#endif
#ifdef HAS_ENVIRONMENT
    if (kind == LIGHT_ENVIRONMENT) {
        emission.direction = -emission.direction; // from there
#ifdef HAS_ENVIRONMENT_MAP
        if (light.cone.z > 0.0) face_image(emission, index);
#endif
        start_around(emission, light, index);
    }
#endif
    emission.normal = emission.direction;
#ifdef HAS_AREA_LIGHTS
    if (kind == LIGHT_AREA) emit_area(emission, light, place, index);
#endif
}

Emission emit_photon(uint index) {
    Emission emission;
    emission.light = choose_light(index);
    LightEmission light = emitters[emission.light];
    float row_rest;
    uint ordinal = scale_fraction(sample_emission(index, 1u), light.grid.w, row_rest);
    uint row = cells[light.grid.z + ordinal] >> 16u;
    uvec2 members = cell_rows[light.first_row.x + row]; // first ordinal of the row, marked cells in it
    float along = (float(ordinal - members.x) + row_rest) / float(members.y);
    float column_rest;
    uint member = scale_fraction(sample_emission(index, 0u), members.y, column_rest);
    uint column = cells[light.grid.z + members.x + member] & 0xffffu;
    float y = 1.0 - 2.0 * (float(row) + along) / float(light.grid.x);
    float sine, cosine;
    sin_cos(2.0 * PI * (float(column) + column_rest) / float(light.grid.y), sine, cosine);
    float radius = sqrt(max(0.0, (1.0 - y) * (1.0 + y)));
    emission.direction = normalize_safely(vec3(radius * cosine, y, radius * sine));
    emission.origin = light.position_kind.xyz;
    emission.normal = emission.direction;
    emission.flux = light.flux_cumulative.rgb;
#if defined(HAS_SPOT_LIGHTS) || defined(HAS_DIRECTIONAL_LIGHTS) || defined(HAS_AREA_LIGHTS) || defined(HAS_ENVIRONMENT)
    emit_otherwise(emission, light, Place((float(column) + column_rest) / float(light.grid.y), (float(row) + along) / float(light.grid.x)), index);
#endif
    return emission;
}
