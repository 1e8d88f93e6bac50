// SPDX-License-Identifier: Apache-2.0
// Places of photons: points of space, or, where all photons lie in one plane of two axes, points of that plane
// (define FLAT_AXES, as in "xz"). Define PERIODIC where space repeats, and `Place period`, 0 where it doesn't.
#include "photons/tree_texels.glsl"

#ifdef FLAT_AXES
#define Place vec2
#define EACH_AXIS(DO) DO(x) DO(y)
#define take_place(v) (v).FLAT_AXES
#else
#define Place vec3
#define EACH_AXIS(DO) DO(x) DO(y) DO(z)
#define take_place(v) (v).xyz
#endif

// Loops over axes are written out: those that the compiler leaves count against the device's limit of turns.

// A place so far off that nobody reaches it, whose square is still a float.
#define FAR_PLACE Place(1e18)
const float FAR_BOUND = 1e17;

// Rounding of wrapped differences, as a share of the period.
const float WRAP_ROUNDING = 4e-7;

#ifdef PERIODIC
Place period;
Place inverse_period; // 0 where space does not repeat
Place wrap_offset(Place d) { return d - period * roundEven(d * inverse_period); }
#else
#define wrap_offset(d) (d)
#endif

float square_length(Place d) {
#ifdef FLAT_AXES
    precise float squared = d.x * d.x + d.y * d.y;
#else
    precise float squared = d.x * d.x + d.y * d.y + d.z * d.z;
#endif
    return squared;
}

void set_period(vec4 space_period) {
#ifdef PERIODIC
    period = take_place(space_period);
#define INVERT(a) inverse_period.a = period.a > 0.0 ? 1.0 / period.a : 0.0;
    EACH_AXIS(INVERT)
#endif
}

Place share_place(Place p, uint lane) {
#define SHARE(a) p.a = broadcast(p.a, lane);
    EACH_AXIS(SHARE)
    return p;
}

// Squared distance from a place to a box.
float measure_box_gap(Place from, Place lo, Place hi) {
    Place gap = max(max(from - hi, lo - from), Place(0.0));
#ifdef PERIODIC
    Place before = max(max(from - hi + period, lo - from - period), Place(0.0));
    Place after = max(max(from - hi - period, lo - from + period), Place(0.0));
    // Wrapping an offset rounds otherwise than wrapping a gap.
    gap = max(min(gap, min(before, after)) - period * WRAP_ROUNDING, Place(0.0));
#endif
    return square_length(gap);
}
