// SPDX-License-Identifier: Apache-2.0
// What lies inside of solid transmissive objects: where rays enter and leave it, how far light flies in it, where it
// goes when it is scattered (METHODS §13). Included where HAS_MEDIA is defined.

// Borders that straight light passes at most.
const uint LARGEST_PASSED_BORDERS = 256u;

struct Medium {
    vec3 extinction; // 1/m
    vec3 albedo;     // share of it that is scattered
    float anisotropy;
    float ior;
    uint object;     // whose inside it is
};

bool is_solid(Material m) { return weigh_dielectric(m) > 0.0 && !is_thin(m); }

// At the border of a fog.
bool is_matched(Material m) { return is_solid(m) && m.absorption_ior.w == 1.0; }

uint find_boundary_object(uint boundary) { return floatBitsToUint(load_corner(boundary - 1u, 0u).w); }

// The medium bounded by a triangle, its number + 1.
Medium load_medium(uint boundary) {
    uint first = MATERIAL_TEXELS * floatBitsToUint(load_corner(boundary - 1u, 1u).w);
    vec4 scattering = materials_at(first + MATERIAL_TEXELS - 1u);
    vec4 absorption_ior = materials_at(first + 1u);
    vec3 extinction = absorption_ior.rgb + scattering.rgb;
    vec3 albedo = mix(scattering.rgb / extinction, vec3(0.0), equal(extinction, vec3(0.0)));
    return Medium(extinction, albedo, scattering.w, absorption_ior.w, find_boundary_object(boundary));
}

bool scatters(Medium medium) { return medium.albedo != vec3(0.0); }

// A ray that meets the back of a solid came through its inside, whatever was known of it before.
void arrive(inout Media media, Surface surface, vec3 direction) {
    bool is_back = is_solid(surface.material) && dot(direction, surface.geometric_normal) > 0.0;
    if (!is_back || (media.inner != 0u && find_boundary_object(media.inner) == surface.object)) return;
    media = Media(surface.triangle + 1u, media.inner);
}

// After light was transmitted by a surface that it met in this direction.
void cross_boundary(inout Media media, Surface surface, vec3 direction) {
    if (!is_solid(surface.material)) return;
    if (dot(direction, surface.geometric_normal) > 0.0) media = Media(media.around, 0u);
    else if (media.inner == 0u || find_boundary_object(media.inner) != surface.object)
        media = Media(surface.triangle + 1u, media.inner);
}

vec3 transmit(vec3 extinction, float distance) {
    vec3 depth = -extinction * distance;
    return vec3(exp_exact(depth.r), exp_exact(depth.g), exp_exact(depth.b));
}

// One free flight: exponential in a channel chosen by the flux it carries, weighed by the density that all channels
// together give the distance. So the sum of the fluxes stays what it is, and no channel's weight grows without bound.
struct Flight {
    float distance; // INFINITY: it is not stopped
    vec3 shares;    // of the channels' flux
};

Flight fly(Medium medium, vec3 flux, uint choice, uint random) {
    float sum = flux.r + flux.g + flux.b;
    vec3 shares = sum > 0.0 ? flux / sum : vec3(1.0 / 3.0);
    float u = to_unit_float(choice);
    float extinction = u < shares.r ? medium.extinction.r : (u < shares.r + shares.g ? medium.extinction.g : medium.extinction.b);
    // 32 bits, never 0: none flies farther than 22 mean free paths.
    float depth = -log_exact((float(random) + 0.5) * (1.0 / 4294967296.0));
    return Flight(extinction > 0.0 ? depth / extinction : INFINITY, shares);
}

// What of each channel's flux passes a distance without being stopped, over the probability that light does.
vec3 weigh_passage(Medium medium, Flight flight, float distance) {
    vec3 passing = transmit(medium.extinction, distance);
    return passing / max(dot(flight.shares, passing), 1e-37);
}

// What of each channel's flux is stopped at the flight's end, over its density.
vec3 weigh_collision(Medium medium, Flight flight) {
    vec3 stopped = medium.extinction * transmit(medium.extinction, flight.distance);
    return stopped / max(dot(flight.shares, stopped), 1e-37);
}

// Henyey and Greenstein 1941, per steradian; `cosine` of the angle between the old and the new direction.
float find_phase(float anisotropy, float cosine) {
    float g2 = anisotropy * anisotropy;
    float x = max(1.0 + g2 - 2.0 * anisotropy * cosine, 1e-12);
    return (1.0 - g2) / (4.0 * PI * x * sqrt(x));
}

// The inverse of its integral, written so that nothing cancels where the anisotropy is small.
vec3 sample_phase(float anisotropy, vec3 direction, uint random, uint turn) {
    float u = to_unit_float(random), g = anisotropy;
    float t = 1.0 - g + 2.0 * g * u;
    float cosine = clamp((2.0 * (1.0 + g * g) * u * (1.0 - g + g * u) - square(1.0 - g)) / (t * t), -1.0, 1.0);
    float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    float s, c;
    sin_cos_turn(turn, s, c);
    vec3 a, b;
    build_basis(direction, a, b);
    return normalize_safely(sine * (c * a + s * b) + cosine * direction);
}

// Share of light that goes straight to `distance`: the borders of fogs let it through, what lies between weakens it
// (`weakens`; without it one looks into all that scatters), other surfaces are in its way.
vec3 pass_media(Ray ray, float distance, Media media, bool weakens) {
    vec3 share = vec3(1.0);
    bool goes_on = true;
    for (uint i = 0u; i < LARGEST_PASSED_BORDERS && goes_on; ++i) {
        Hit hit = intersect_scene(ray, distance, false);
        goes_on = hit.t < distance;
        Surface surface;
        if (goes_on) {
            surface = load_surface(hit);
            arrive(media, surface, ray.direction);
        }
        float way = min(hit.t, distance);
        if (weakens && media.inner != 0u && way < INFINITY) share *= transmit(load_medium(media.inner).extinction, way);
        if (!goes_on) return share;
        bool is_open = is_matched(surface.material) || (!weakens && scatters(load_medium(surface.triangle + 1u)));
        vec3 passing = is_open ? weigh_dielectric(surface.material) * surface.material.base_color_metallic.rgb : vec3(0.0);
        cross_boundary(media, surface, ray.direction);
#ifdef HAS_ALPHA
        float coverage = find_coverage(surface.material);
        passing = coverage * passing + (1.0 - coverage);
#endif
        share *= passing;
        goes_on = share != vec3(0.0);
        ray = leave_surface(surface, ray.direction);
        distance -= hit.t;
    }
    return goes_on ? share : vec3(0.0);
}
