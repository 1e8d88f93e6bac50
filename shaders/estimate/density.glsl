// SPDX-License-Identifier: Apache-2.0
// The kernels of density estimation (METHODS §2). Define KERNEL, IN_SPACE (METHODS §13: balls instead of discs).
#include "shared/math.glsl"

// r for a set that takes every photon: a little beyond the farthest, so that its weight is not lost to rounding.
const float BEYOND_FARTHEST = 1.000001;
const float FLOAT_EPSILON = 1.1920929e-7;
const float SMALLEST_RADIUS = 1e-15; // its square is still a normal float

// Weight of a photon at squared distance s = d²/r², times π r²; in space times the ball's volume.
float weigh_photon(float s) {
#ifdef IN_SPACE // Epanechnikov: 15/(8π r³) (1 - s)
    return 2.5 * max(0.0, 1.0 - s);
#elif KERNEL == 0 // KERNEL_EPANECHNIKOV
    return 2.0 * max(0.0, 1.0 - s);
#elif KERNEL == 1 // KERNEL_DISC; (k - 1)/k of it in estimate_irradiance
    return 1.0;
#elif KERNEL == 2 // KERNEL_CONE: 1 - d/(c r), normalized by 1 - 2/(3c), c = 1.1 (Jensen)
    return (1.0 - sqrt(s) / 1.1) / (1.0 - 2.0 / 3.3);
#else // KERNEL_GAUSSIAN: Jensen's 0.918 (1 - (1 - e^(-β s/2))/(1 - e^-β)), β = 1.953, normalized by 0.531
    return 0.918 * (1.0 - (1.0 - exp_exact(-1.953 * 0.5 * s)) / (1.0 - exp_exact(-1.953))) / 0.531;
#endif
}

// Largest radius that floats at this place cannot tell from 0: photons closer than that are spread over it.
float find_spacing(vec3 p) { return max(max(abs(p.x), max(abs(p.y), abs(p.z))) * FLOAT_EPSILON, SMALLEST_RADIUS); }

// Irradiance from the weighted flux within r. In two steps: π r² of a tiny radius would underflow.
#ifdef IN_SPACE
vec4 spread_flux(vec4 flux, float r) { return flux / r / r / (4.0 / 3.0 * PI * r); }
#else
vec4 spread_flux(vec4 flux, float r) { return flux / r / (PI * r); }
#endif
