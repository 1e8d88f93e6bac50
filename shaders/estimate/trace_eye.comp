// SPDX-License-Identifier: Apache-2.0
// Follows eye paths through mirrors and glass to the diffuse surfaces they see.
// Inputs: scene, environment_map. Outputs: per slot hit_point (xyz, w 1: used), hit_normal (w bits: the medium there), hit_weight (rgb: radiance per irradiance, w bits: the
// normal as a texture turns it, 0 where none does);
// per sample eye_emission (rgb: emitted radiance seen).
// Dielectrics split into both directions while slots last, then one is chosen at random.
// Rough surfaces show point, spot and directional lights themselves (lights).
// Defines: HAS_DIELECTRIC, HAS_MIRROR, HAS_ROUGH (then also those of lights), HAS_ABSORPTION, HAS_TEXTURES,
// HAS_VERTEX_COLORS, HAS_ALPHA, HAS_ENVIRONMENT_MAP, HAS_TRANSLUCENCY, HAS_LAYERS, HAS_DISPERSION,
// HAS_MEDIA (then not HAS_ABSORPTION): outputs beam_origin, beam_direction, beam_weight of stretches in media (METHODS §13).
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/render.h"
#include "scene/scatter.glsl"
#ifdef HAS_ROUGH
#include "estimate/light_beams.glsl"
#endif
#ifdef HAS_ENVIRONMENT_MAP
#include "scene/environment.glsl"
#endif
#pragma binding writeonly vec4 hit_point
#pragma binding writeonly vec4 hit_normal
#pragma binding writeonly vec4 hit_weight
#pragma binding writeonly vec4 eye_emission
#ifdef HAS_MEDIA
#pragma binding writeonly vec4 beam_origin
#pragma binding writeonly vec4 beam_direction
#pragma binding writeonly vec4 beam_weight
#endif

layout(push_constant) uniform Push { EyeSettings settings; };

const uint LARGEST_SLOT_COUNT = 4u;
// Branches that carry less than this share of the pixel are dropped by roulette.
const float SMALL_WEIGHT = 1e-3;

struct Branch {
    Ray ray;
    vec3 weight;
    uint bounce;
    float band; // place in the spectrum, in [0, 1); negative: white light
    Media media;
};

Branch waiting[LARGEST_SLOT_COUNT];
uint waiting_count = 0u;
uint sample_index;
uint used_slots = 0u;
uint used_beams = 0u;
uint hit_medium = 0u; // Media::inner where a surface is met
vec3 seen_emission = vec3(0.0);

// Which facet of a rough surface the path meets, in [0, 1)².
vec2 choose_facet(uint bounce) {
#ifdef HAS_ROUGH
    uvec4 random = random_words(settings.seed, sample_index, bounce, 40u + used_slots);
    return vec2(to_unit_float(random.x), to_unit_float(random.y));
#else
    return vec2(0.0);
#endif
}

// Of surfaces that are there in part.
uint choose_coverage(uint bounce) {
#ifdef HAS_ALPHA
    return random_bits(settings.seed, sample_index, bounce, 48u + used_slots);
#else
    return 0u;
#endif
}

float draw(uint bounce, uint dimension) {
    return to_unit_float(random_bits(settings.seed, sample_index, bounce, 16u + dimension + 4u * used_slots));
}

Branch start_branch() {
    uint pixel = sample_index / settings.samples;
    uint within = sample_index % settings.samples;
    uint scramble = random_bits(settings.seed, pixel, 0xfffffffeu, 0u);
    float dx = to_unit_float(scramble_owen(sobol_bits(within, 0u), scramble));
    float dy = to_unit_float(scramble_owen(sobol_bits(within, 1u), scramble ^ 0x9e3779b9u));
    float x = 2.0 * (float(pixel % settings.width) + dx) / float(settings.width) - 1.0;
    float y = 1.0 - 2.0 * (float(pixel / settings.width) + dy) / float(settings.height);
    vec3 direction = normalize_safely(settings.camera.forward.xyz + x * settings.camera.right.xyz + y * settings.camera.up.xyz);
    return Branch(Ray(settings.camera.position.xyz, direction), vec3(1.0), 0u, -1.0, Media(settings.media.x, settings.media.y));
}

uint locate_slot(uint slot) { return slot * settings.sample_count + sample_index - settings.first_sample; }

// `side`: 1 on the side that is seen, -1 beyond; `weight`: radiance for each exitance.
void record_hit(Surface surface, vec3 direction, float side, vec3 weight) {
    if (used_slots >= settings.slot_count) return;
    uint at = locate_slot(used_slots);
    vec3 normal = side * face_smoothly(surface, direction);
    vec3 bent = side * face_arrival(surface, direction);
    hit_point[at] = vec4(leave_surface(surface, normal).origin, 1.0);
    hit_normal[at] = vec4(normal, uintBitsToFloat(hit_medium));
    hit_weight[at] = vec4(weight / PI, bent == normal ? 0.0 : uintBitsToFloat(pack_normal(bent)));
    ++used_slots;
}

// Whether so many hits leave one for each branch that waits.
bool has_room(uint hits) { return used_slots + waiting_count + hits <= settings.slot_count; }

float draw_layer(uint bounce, uint dimension) {
    return to_unit_float(random_bits(settings.seed, sample_index, bounce, 56u + 8u * dimension + used_slots));
}

// `kept`: hits that must be left besides.
void record_diffuse(Branch branch, Surface surface, vec3 weight, uint kept) {
    vec3 direction = branch.ray.direction;
#ifdef HAS_TRANSLUCENCY
    // Both sides, or one by its probability.
    float passing = surface.material.translucency.w;
    bool takes_both = has_room(2u + kept);
    bool takes_beyond = takes_both ? passing > 0.0 : draw_layer(branch.bounce, 0u) < passing;
    if (takes_beyond) record_hit(surface, direction, -1.0, weight * (takes_both ? passing : 1.0) * surface.material.translucency.rgb);
    if (takes_both ? passing >= 1.0 : takes_beyond) return;
    weight *= takes_both ? 1.0 - passing : 1.0;
#endif
    record_hit(surface, direction, 1.0, weight * surface.material.base_color_metallic.rgb);
}

#ifdef HAS_DISPERSION
// White light takes a place in the spectrum where it first meets glass that disperses, another for each sample of a pixel.
void choose_band(inout Branch branch) {
    if (branch.band >= 0.0) return;
    uint pixel = sample_index / settings.samples;
    float offset = to_unit_float(random_bits(settings.seed, pixel, 0xfffffffcu, 0u));
    branch.band = fract((float(sample_index % settings.samples) + offset) / float(settings.samples));
    branch.weight *= color_band(branch.band);
}
#endif

void wait_branch(Branch branch) {
    waiting[waiting_count] = branch;
    ++waiting_count;
}

bool survive_roulette(inout Branch branch) {
    float largest = max(branch.weight.r, max(branch.weight.g, branch.weight.b));
    if (largest >= SMALL_WEIGHT) return true;
    if (draw(branch.bounce, 2u) >= largest / SMALL_WEIGHT) return false;
    branch.weight *= SMALL_WEIGHT / largest;
    return true;
}

// Follows both directions when a slot is left for each, else one by its probability.
void split_dielectric(inout Branch branch, Surface surface) {
#ifdef HAS_DISPERSION
    if (surface.material.alpha.w > 0.0) {
        choose_band(branch);
        surface.material.absorption_ior.w = find_index(surface.material, branch.band);
    }
#endif
    Interface face = meet_dielectric(surface, branch.ray.direction, choose_facet(branch.bounce));
    vec3 tint = face.transmitted_share * surface.material.base_color_metallic.rgb;
    Branch reflected = Branch(leave_surface(surface, face.reflected),
                              branch.weight * (face.reflectance * face.reflected_share), branch.bounce, branch.band, branch.media);
    Branch transmitted = Branch(leave_surface(surface, face.transmitted),
                                branch.weight * (1.0 - face.reflectance) * tint, branch.bounce, branch.band, branch.media);
#ifdef HAS_MEDIA
    cross_boundary(transmitted.media, surface, branch.ray.direction);
#endif
    bool can_split = used_slots + waiting_count + 2u <= settings.slot_count && face.reflectance > 0.0 && face.reflectance < 1.0;
    if (can_split) {
        ++reflected.bounce;
        if (survive_roulette(reflected)) wait_branch(reflected);
        branch = transmitted;
    } else if (draw(branch.bounce, 0u) < face.reflectance) {
        reflected.weight = branch.weight * face.reflected_share;
        branch = reflected;
    } else {
        transmitted.weight = branch.weight * tint;
        branch = transmitted;
    }
}

#ifdef HAS_ROUGH
// Radiance that lights without extent send off a rough surface to the eye; its others the path itself meets.
vec3 shine_back(Surface surface, vec3 direction, float band) {
    vec3 sum = vec3(0.0);
#ifdef HAS_DISPERSION
    if (band >= 0.0) surface.material.absorption_ior.w = find_index(surface.material, band);
#endif
    for (uint i = 0u; i < floatBitsToUint(settings.environment.w); ++i) {
        Beam beam;
        if (!find_beam(lights[i], surface.position, beam)) continue;
        vec3 share = scatter_rough(surface, direction, beam.direction);
        Ray ray = leave_surface(surface, beam.direction);
        if (share != vec3(0.0)) sum += share * beam.irradiance * pass_scene(ray, beam.distance);
    }
    return sum;
}
#endif

void follow_lobe(inout Branch branch, Surface surface, Lobe lobe) {
    branch.weight *= lobe.share;
    branch.ray = leave_surface(surface, lobe.direction);
}

// One of the lobes that are not diffuse; `choice` in [0, their share together).
void follow_specular(inout Branch branch, Surface surface, LobeShares shares, float choice) {
    vec3 direction = branch.ray.direction;
    bool is_glass = choice >= shares.mirror + shares.gloss + shares.coat;
#ifdef HAS_MIRROR
    if (choice < shares.mirror) follow_lobe(branch, surface, reflect_metal(surface, direction, choose_facet(branch.bounce)));
#endif
#ifdef HAS_LAYERS
    if (!is_glass && choice >= shares.mirror) {
        if (choice < shares.mirror + shares.gloss)
            follow_lobe(branch, surface, reflect_gloss(surface, direction, choose_facet(branch.bounce), shares));
        else follow_lobe(branch, surface, reflect_coat(surface, direction, choose_facet(branch.bounce), shares));
    }
#endif
#ifdef HAS_DIELECTRIC
    if (is_glass) split_dielectric(branch, surface);
#endif
}

#ifdef HAS_MEDIA
uint locate_beam(uint beam) { return beam * settings.sample_count + sample_index - settings.first_sample; }

// The way to a surface: what lies in a medium is looked through, and kept to see what photons send along it. Of stretches
// beyond those there is room for only what they take away is seen.
void look_through(inout Branch branch, Surface surface, float distance) {
    arrive(branch.media, surface, branch.ray.direction);
    if (branch.media.inner == 0u) return;
    Medium medium = load_medium(branch.media.inner);
    if (scatters(medium) && used_beams < settings.media.z) {
        uint at = locate_beam(used_beams);
        beam_origin[at] = vec4(branch.ray.origin, distance);
        beam_direction[at] = vec4(branch.ray.direction, uintBitsToFloat(branch.media.inner));
        // Radiance goes with the square of the index, which the way in and out of glass need not say.
        float camera_ior = settings.media.x == 0u ? 1.0 : load_medium(settings.media.x).ior;
        beam_weight[at] = vec4(branch.weight * square(camera_ior / medium.ior), 0.0);
        ++used_beams;
    }
    branch.weight *= transmit(medium.extinction, distance);
}
#endif

// One surface of a branch; false when the branch ends here.
bool follow_surface(inout Branch branch, Surface surface, float distance) {
#ifdef HAS_MEDIA
    look_through(branch, surface, distance);
    hit_medium = branch.media.inner;
#elif defined(HAS_ABSORPTION)
    branch.weight *= transmit_interior(surface, branch.ray.direction, distance);
#endif
    if (surface.material.roughness_thin.z > 0.0 || dot(branch.ray.direction, surface.geometric_normal) < 0.0)
        seen_emission += branch.weight * surface.material.emission_transmission.rgb;
    LobeShares shares = share_lobes(surface, branch.ray.direction);
    // What is diffuse in part is seen and seen through, or either by its probability where hits run short.
    bool goes_on = shares.diffuse < 1.0 && branch.bounce < settings.max_bounces;
    bool splits = shares.diffuse > 0.0 && goes_on;
    bool takes_both = splits && has_room(2u);
    if (splits && !takes_both) {
        goes_on = draw_layer(branch.bounce, 1u) >= shares.diffuse;
        branch.weight /= goes_on ? 1.0 - shares.diffuse : shares.diffuse;
    }
    if (shares.diffuse > 0.0 && (takes_both || !goes_on)) record_diffuse(branch, surface, branch.weight * shares.diffuse, goes_on ? 1u : 0u);
    if (!goes_on) return false;
#ifdef HAS_ROUGH
    if (has_rough_lobe(surface.material)) seen_emission += branch.weight * shine_back(surface, branch.ray.direction, branch.band);
#endif
    branch.weight *= 1.0 - shares.diffuse;
    follow_specular(branch, surface, shares, draw(branch.bounce, 1u) * (1.0 - shares.diffuse));
    ++branch.bounce;
    return survive_roulette(branch);
}

// Where nothing is met.
vec3 see_beyond(vec3 direction) {
    vec3 radiance = settings.environment.rgb;
#ifdef HAS_ENVIRONMENT_MAP
    radiance += see_environment(load_environment(), direction).radiance;
#endif
    return radiance;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.sample_count) return;
    sample_index = settings.first_sample + gl_GlobalInvocationID.x;
    Branch branch = start_branch();
    bool alive = true;
    while (alive) {
        Hit hit = meet_scene(branch.ray, choose_coverage(branch.bounce));
        if (hit.t == INFINITY) seen_emission += branch.weight * see_beyond(branch.ray.direction);
        alive = hit.t < INFINITY && follow_surface(branch, load_surface(hit), hit.t);
        if (!alive && waiting_count > 0u) {
            --waiting_count;
            branch = waiting[waiting_count];
            alive = true;
        }
    }
    for (uint slot = used_slots; slot < settings.slot_count; ++slot) {
        hit_point[locate_slot(slot)] = vec4(0.0);
        hit_normal[locate_slot(slot)] = vec4(0.0);
        hit_weight[locate_slot(slot)] = vec4(0.0);
    }
#ifdef HAS_MEDIA
    for (uint beam = used_beams; beam < settings.media.z; ++beam) beam_origin[locate_beam(beam)] = vec4(0.0);
#endif
    eye_emission[gl_GlobalInvocationID.x] = vec4(seen_emission, 0.0);
}
