// SPDX-License-Identifier: Apache-2.0
// Emission: from the emitted index to a light and a direction inside its projection map's marked cells (METHODS §1).
// The unit square is mapped onto the marked cells row by row, so that its stratification is kept.

struct Emission {
    uint light;
    vec3 origin;
    vec3 direction;
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
    uint light = 0u;
    while (light + 1u < settings.light_count && u >= emitters[light].flux_cumulative.w) ++light;
    return light;
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
    emission.flux = light.flux_cumulative.rgb;
    return emission;
}
