// SPDX-License-Identifier: Apache-2.0
// Parameters of photons (METHODS §4): distances in parameter space, and who belongs to whose layer.
// Define PARAMETER_COUNT (1–13), PARAMETER_ROWS (vec4s that hold them), and PERIODIC_PARAMETERS where one wraps.
// Inputs: tree_parameters (tree order, NaN where a photon has none), with wraps parameter_periods (0: none).
#pragma binding texel tree_parameters

struct Parameters {
    float q[PARAMETER_COUNT];
};

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

Parameters load_parameters(uint position) {
    Parameters p;
    for (uint row = 0u; row < PARAMETER_ROWS; ++row) {
        vec4 values = tree_parameters_at(PARAMETER_ROWS * position + row);
        for (uint c = 0u; c < 4u; ++c)
            if (4u * row + c < PARAMETER_COUNT) p.q[4u * row + c] = values[c];
    }
    return p;
}

Parameters share_parameters(Parameters mine, uint lane) {
    Parameters p;
    for (uint i = 0u; i < PARAMETER_COUNT; ++i) p.q[i] = subgroupBroadcast(mine.q[i], lane);
    return p;
}

#ifdef PERIODIC_PARAMETERS
#pragma binding readonly float parameter_periods
float parameter_period[PARAMETER_COUNT];
float parameter_inverse[PARAMETER_COUNT];

void load_periods() {
    for (uint i = 0u; i < PARAMETER_COUNT; ++i) {
        parameter_period[i] = parameter_periods[i];
        parameter_inverse[i] = parameter_period[i] > 0.0 ? 1.0 / parameter_period[i] : 0.0;
    }
}
#else
void load_periods() {}
#endif

// Squared distance on the raw values; NaN where either photon has none.
float measure_parameters(Parameters a, Parameters b) {
    precise float sum = 0.0;
    for (uint i = 0u; i < PARAMETER_COUNT; ++i) {
        precise float d = a.q[i] - b.q[i];
#ifdef PERIODIC_PARAMETERS
        d = d - parameter_period[i] * roundEven(d * parameter_inverse[i]);
#endif
        sum = sum + d * d;
    }
    return sum;
}
