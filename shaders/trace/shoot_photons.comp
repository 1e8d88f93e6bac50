// SPDX-License-Identifier: Apache-2.0
// Shoots one chunk of photons and records every path's vertices and deposits in scratch slots (METHODS §1).
// Inputs: scene, emitters, cells, cell_rows (projection maps), lane_order (coherent order of a chunk).
// Outputs: summaries, deposited_flux, lost_flux, emitted_flux (with HAS_COLORED_EMISSION), and per slot scratch_position, scratch_normal, scratch_power.
// Defines: STORE_MODE, EMISSION, RECORD_PATHS (keep specular vertices too), HAS_DIELECTRIC, HAS_MIRROR,
// HAS_ROUGH, HAS_TEXTURES, HAS_VERTEX_COLORS, HAS_ALPHA, HAS_ABSORPTION, HAS_SEVERAL_LIGHTS, HAS_SPOT_LIGHTS,
// HAS_DIRECTIONAL_LIGHTS, HAS_AREA_LIGHTS (then also emitting), HAS_ENVIRONMENT, HAS_ENVIRONMENT_MAP (then also environment_map),
// HAS_COLORED_LAMPS, HAS_COLORED_EMISSION (either of the two), HAS_TRANSLUCENCY, HAS_LAYERS, HAS_DISPERSION,
// HAS_MEDIA (then not HAS_ABSORPTION).
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/trace.h"
#ifdef HAS_MEDIA
#include "shared/photons.h"
#endif
#include "scene/scatter.glsl"
#pragma binding readonly LightEmission emitters
#pragma binding readonly uint cells
#pragma binding readonly uvec2 cell_rows
#pragma binding readonly uint lane_order
#pragma binding writeonly PathSummary summaries
#pragma binding writeonly vec4 deposited_flux
#pragma binding writeonly vec4 lost_flux
#pragma binding writeonly vec4 emitted_flux
#pragma binding writeonly vec4 scratch_position
#pragma binding writeonly vec4 scratch_normal
#pragma binding writeonly vec4 scratch_power

layout(push_constant) uniform Push { TraceSettings settings; };

#include "trace/emit.glsl"
#include "trace/path_state.glsl"

// Light leaves a diffuse surface, on this side or beyond, or the path ends there; `choice` in [0, 1).
uint scatter_diffuse(inout PathState path, Surface surface, vec3 normal, uvec4 random, float choice) {
#if STORE_MODE == 0 // STORE_CAUSTIC: nothing behind a diffuse surface can be stored
    end_path(path, OUTCOME_RECEIVED);
    return INTERACTION_REFLECTED;
#else
    bool passes = false;
    vec3 color = surface.material.base_color_metallic.rgb;
#ifdef HAS_TRANSLUCENCY
    passes = choice < surface.material.translucency.w;
    if (passes) color = surface.material.translucency.rgb;
#endif
    if (survive(path, color, random.y)) {
        vec3 side = passes ? -normal : normal;
        path.ray = leave_surface(surface, leave_diffusely(surface, side, to_unit_float(random.z), to_unit_float(random.w)));
        path.met_diffuse = true;
    }
    return passes ? INTERACTION_TRANSMITTED : INTERACTION_REFLECTED;
#endif
}

// Which facet of a rough surface the path meets, in [0, 1)².
vec2 choose_facet(PathState path) {
#ifdef HAS_ROUGH
    uvec4 random = random_words(settings.seed, path.index, path.bounce, 2u);
    return vec2(to_unit_float(random.x), to_unit_float(random.y));
#else
    return vec2(0.0);
#endif
}

// Of surfaces that are there in part.
uint choose_coverage(PathState path) {
#ifdef HAS_ALPHA
    return random_bits(settings.seed, path.index, path.bounce, 3u);
#else
    return 0u;
#endif
}

void follow_lobe(inout PathState path, Surface surface, Lobe lobe, uvec4 random) {
    if (!survive(path, lobe.share, random.y)) return;
    path.ray = leave_surface(surface, lobe.direction);
    path.met_specular = true;
}

#ifdef HAS_DISPERSION
// White light takes a place in the spectrum when it first meets glass that disperses; the rest of its flux stays there.
void choose_band(inout PathState path) {
    if (path.band >= 0.0) return;
    uint kind = floatBitsToUint(emitters[path.light].position_kind.w);
    bool is_free = kind != LIGHT_AREA && kind != LIGHT_ENVIRONMENT; // else the dimension says where light starts
    uint bits = is_free ? sample_emission(path.index, 4u) : random_bits(settings.seed, path.index, path.bounce, 4u);
    path.band = to_unit_float(bits);
    vec3 leaving = path.flux * color_band(path.band);
    path.deposited += path.flux - leaving;
    path.flux = leaving;
}
#endif

uint scatter_dielectric(inout PathState path, Surface surface, uvec4 random) {
#ifdef HAS_DISPERSION
    if (surface.material.alpha.w > 0.0) {
        choose_band(path);
        surface.material.absorption_ior.w = find_index(surface.material, path.band);
    }
#endif
    vec3 arrival = path.ray.direction;
    Interface face = meet_dielectric(surface, arrival, choose_facet(path));
#ifdef HAS_MEDIA
    path.met_specular = path.met_specular || !is_matched(surface.material);
#else
    path.met_specular = true;
#endif
    if (to_unit_float(random.z) < face.reflectance) {
        if (survive(path, vec3(face.reflected_share), random.y)) path.ray = leave_surface(surface, face.reflected);
        return INTERACTION_REFLECTED;
    }
    if (survive(path, face.transmitted_share * surface.material.base_color_metallic.rgb, random.y))
        path.ray = leave_surface(surface, face.transmitted);
#ifdef HAS_MEDIA
    cross_boundary(path.media, surface, arrival);
#endif
    return INTERACTION_TRANSMITTED;
}

#ifdef HAS_MEDIA
// Light is stopped in the medium: it is stored if the set asks for it, and goes on in a new direction or is absorbed.
void scatter_in_medium(inout PathState path, Medium medium, Flight flight, uvec4 random) {
    vec3 arrival = path.ray.direction;
    vec3 position = path.ray.origin + flight.distance * arrival;
    weigh_flux(path, weigh_collision(medium, flight));
    vec3 arriving = path.flux;
    bool stores = is_stored(path);
    if (STORE_MODE == STORE_CAUSTIC) {
        end_path(path, OUTCOME_RECEIVED); // as behind a diffuse surface
    } else if (path.bounce == settings.max_bounces) {
        end_path(path, OUTCOME_TRUNCATED);
    } else if (survive_in_sum(path, medium.albedo, random_bits(settings.seed, path.index, path.bounce, 6u))) {
        path.ray = Ray(position, sample_phase(medium.anisotropy, arrival, random.z, random.w));
        path.met_diffuse = true;
    }
    record_vertex(path, position, medium.object, -MEDIUM_NORMAL_LENGTH * arrival, INTERACTION_SCATTERED, 1.0, arriving, stores);
}

// The way to the surface; false where the path does not get there.
bool pass_medium(inout PathState path, Surface surface, float distance) {
    arrive(path.media, surface, path.ray.direction);
    if (path.media.inner == 0u) return true;
    Medium medium = load_medium(path.media.inner);
    if (!scatters(medium))
        return survive(path, transmit(medium.extinction, distance), random_bits(settings.seed, path.index, path.bounce, 1u));
    uvec4 random = random_words(settings.seed, path.index, path.bounce, 5u);
    Flight flight = fly(medium, path.flux, random.x, random.y);
    if (flight.distance < distance) scatter_in_medium(path, medium, flight, random);
    else weigh_flux(path, weigh_passage(medium, flight, distance));
    return !(flight.distance < distance);
}
#endif

// Stores the deposit if the set asks for it, then chooses a lobe and goes on.
void meet_surface(inout PathState path, Surface surface, float distance) {
    vec3 arrival = path.ray.direction;
    vec3 normal = face_arrival(surface, arrival);
    uvec4 random = random_words(settings.seed, path.index, path.bounce, 0u); // lobe, roulette, direction
#ifdef HAS_ABSORPTION
    if (!survive(path, transmit_interior(surface, path.ray.direction, distance),
                 random_bits(settings.seed, path.index, path.bounce, 1u))) return;
#endif
    LobeShares shares = share_lobes(surface, path.ray.direction);
    float diffuse = shares.diffuse;
    bool stores = diffuse > 0.0 && is_stored(path);
    vec3 arriving = path.flux;
    uint interaction = INTERACTION_REFLECTED;
    if (path.bounce == settings.max_bounces && !(STORE_MODE == STORE_CAUSTIC && diffuse == 1.0)) {
        end_path(path, OUTCOME_TRUNCATED);
    } else {
        float choice = to_unit_float(random.x);
        if (choice < diffuse) interaction = scatter_diffuse(path, surface, normal, random, choice / diffuse);
#ifdef HAS_MIRROR
        else if (choice < diffuse + shares.mirror) follow_lobe(path, surface, reflect_metal(surface, arrival, choose_facet(path)), random);
#endif
#ifdef HAS_LAYERS
        else if (choice < diffuse + shares.mirror + shares.gloss)
            follow_lobe(path, surface, reflect_gloss(surface, arrival, choose_facet(path), shares), random);
        else if (choice < diffuse + shares.mirror + shares.gloss + shares.coat)
            follow_lobe(path, surface, reflect_coat(surface, arrival, choose_facet(path), shares), random);
#endif
#ifdef HAS_DIELECTRIC
        else interaction = scatter_dielectric(path, surface, random);
#endif
    }
    float scatter = diffuse;
#ifdef HAS_ROUGH
    scatter += (1.0 - diffuse) * min(surface.material.roughness_thin.x, 1.0);
#endif
    record_vertex(path, surface.position, surface.object, face_smoothly(surface, arrival), interaction, scatter, arriving, stores);
}

// One segment of the path: to the next surface, or away.
void follow_segment(inout PathState path) {
    Hit hit = meet_scene(path.ray, choose_coverage(path));
    if (hit.t == INFINITY) {
        end_path(path, OUTCOME_ESCAPED);
    } else {
        Surface surface = load_surface(hit);
#ifdef HAS_MEDIA
        if (pass_medium(path, surface, hit.t))
#endif
        meet_surface(path, surface, hit.t);
    }
    ++path.bounce;
    if (!path.alive) finish_path(path);
}

// Marks what the workgroup had no turns left for; the host shoots the chunk again with fewer paths a lane.
void give_up(PathState path, uint next, uint end) {
    if (path.alive) {
        path.outcome = OUTCOME_UNFINISHED;
        finish_path(path);
    }
    for (uint turn = next + gl_LocalInvocationID.x; turn < end; turn += gl_WorkGroupSize.x) {
        uint slot = lane_order[turn];
        if (slot < settings.count) summaries[slot] = PathSummary(OUTCOME_UNFINISHED, 0u, 0u, 0u);
    }
}

// A subgroup owns paths_per_lane paths per lane; a lane whose path ends takes the next one, so that none waits for
// the longest path.
void main() {
    uint next = gl_WorkGroupID.x * gl_WorkGroupSize.x * settings.paths_per_lane;
    uint end = min(next + gl_WorkGroupSize.x * settings.paths_per_lane, settings.chunk_size);
    PathState path;
    path.alive = false;
    bool busy = true;
    while (busy) {
        uvec2 idle = find_lanes(!path.alive);
        uint turn = next + count_before(idle);
        next += count_lanes(idle);
        if (!path.alive && turn < end) {
            uint slot = lane_order[turn];
            if (slot < settings.count) path = start_path(settings.first + slot, slot); // a last chunk may be shorter
        }
        if (path.alive) follow_segment(path);
        ++turns;
        busy = (any_lane(path.alive) || next < end) && all_lanes(has_turns_left());
    }
    give_up(path, next, end);
}
