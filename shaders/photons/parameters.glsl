// SPDX-License-Identifier: Apache-2.0
// Parameters of photons (METHODS §4): distances in parameter space, and who belongs to whose layer.
// Define PARAMETER_COUNT (1–13), PARAMETER_ROWS (vec4s that hold them), EACH_PARAMETER(DO), the calls DO(0) … DO(count
// - 1), since loops would count against the device's limit, and PERIODIC_PARAMETERS where one wraps.
// Inputs: tree_parameters (tree order, NaN where a photon has none), with wraps parameter_periods (0: none).
#pragma binding texel tree_parameters

struct Parameters {
    float q[PARAMETER_COUNT];
};

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

Parameters load_parameters(uint position) {
    Parameters p;
#define LOAD_PARAMETER(i) p.q[i] = tree_parameters_at(PARAMETER_ROWS * position + i / 4)[i % 4];
    EACH_PARAMETER(LOAD_PARAMETER)
    return p;
}

Parameters share_parameters(Parameters mine, uint lane) {
    Parameters p;
#define SHARE_PARAMETER(i) p.q[i] = subgroupBroadcast(mine.q[i], lane);
    EACH_PARAMETER(SHARE_PARAMETER)
    return p;
}

// Whether any of them is missing.
bool is_unset(Parameters p) {
    bool missing = false;
#define TEST_PARAMETER(i) missing = missing || is_nan(p.q[i]);
    EACH_PARAMETER(TEST_PARAMETER)
    return missing;
}

#ifdef PERIODIC_PARAMETERS
#pragma binding readonly float parameter_periods
float parameter_period[PARAMETER_COUNT];
float parameter_inverse[PARAMETER_COUNT];

void load_periods() {
#define LOAD_PERIOD(i) parameter_period[i] = parameter_periods[i]; \
    parameter_inverse[i] = parameter_period[i] > 0.0 ? 1.0 / parameter_period[i] : 0.0;
    EACH_PARAMETER(LOAD_PERIOD)
}
#else
void load_periods() {}
#endif

// Squared distance on the raw values; NaN where either photon has none.
float measure_parameters(Parameters a, Parameters b) {
    precise float sum = 0.0;
#ifdef PERIODIC_PARAMETERS
#define WRAP_PARAMETER(i) d = d - parameter_period[i] * roundEven(d * parameter_inverse[i]);
#else
#define WRAP_PARAMETER(i)
#endif
#define MEASURE_PARAMETER(i) { precise float d = a.q[i] - b.q[i]; WRAP_PARAMETER(i) sum = sum + d * d; }
    EACH_PARAMETER(MEASURE_PARAMETER)
    return sum;
}
