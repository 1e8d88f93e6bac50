// SPDX-License-Identifier: Apache-2.0
// Shoots one chunk of photons and records every path's vertices and deposits in scratch slots (METHODS §1).
// Inputs: scene, emitters, cells, cell_rows (projection maps), lane_order (coherent order of a chunk).
// Outputs: summaries, deposited_flux, lost_flux, and per slot scratch_position, scratch_normal, scratch_power.
// Defines: STORE_MODE, EMISSION, RECORD_PATHS (keep specular vertices too), HAS_DIELECTRIC, HAS_MIRROR, HAS_ABSORPTION.
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/trace.h"
#include "scene/scatter.glsl"
#pragma binding readonly LightEmission emitters
#pragma binding readonly uint cells
#pragma binding readonly uvec2 cell_rows
#pragma binding readonly uint lane_order
#pragma binding writeonly PathSummary summaries
#pragma binding writeonly vec4 deposited_flux
#pragma binding writeonly vec4 lost_flux
#pragma binding writeonly vec4 scratch_position
#pragma binding writeonly vec4 scratch_normal
#pragma binding writeonly vec4 scratch_power

layout(push_constant) uniform Push { TraceSettings settings; };

#include "trace/emit.glsl"
#include "trace/path_state.glsl"

// Light leaves a diffuse surface, or the path ends there.
void scatter_diffuse(inout PathState path, Surface surface, vec3 normal) {
#if STORE_MODE == 0 // STORE_CAUSTIC: nothing behind a diffuse surface can be stored
    end_path(path, OUTCOME_RECEIVED);
#else
    if (!survive(path, surface.material.base_color_metallic.rgb, 1u)) return;
    float u1 = to_unit_float(random_bits(settings.seed, path.index, path.bounce, 2u));
    float u2 = to_unit_float(random_bits(settings.seed, path.index, path.bounce, 3u));
    path.ray = leave_surface(surface, sample_cosine(normal, u1, u2));
    path.met_diffuse = true;
#endif
}

void scatter_mirror(inout PathState path, Surface surface) {
    float cosine = -dot(path.ray.direction, face_arrival(surface, path.ray.direction));
    if (!survive(path, reflect_schlick(surface.material, cosine), 1u)) return;
    path.ray = leave_surface(surface, reflect_direction(surface, path.ray.direction));
    path.met_specular = true;
}

uint scatter_dielectric(inout PathState path, Surface surface) {
    Interface face = meet_dielectric(surface, path.ray.direction);
    path.met_specular = true;
    if (to_unit_float(random_bits(settings.seed, path.index, path.bounce, 4u)) < face.reflectance) {
        path.ray = leave_surface(surface, reflect_direction(surface, path.ray.direction));
        return INTERACTION_REFLECTED;
    }
    if (survive(path, surface.material.base_color_metallic.rgb, 1u))
        path.ray = leave_surface(surface, face.transmitted);
    return INTERACTION_TRANSMITTED;
}

// Stores the deposit if the set asks for it, then chooses a lobe and goes on.
void meet_surface(inout PathState path, Surface surface, float distance) {
    vec3 normal = face_arrival(surface, path.ray.direction);
#ifdef HAS_ABSORPTION
    if (!survive(path, transmit_interior(surface, path.ray.direction, distance), 0u)) return;
#endif
    float diffuse = weigh_diffuse(surface.material);
    bool stores = diffuse > 0.0 && is_stored(path);
    vec3 arriving = path.flux;
    uint interaction = INTERACTION_REFLECTED;
    if (path.bounce == settings.max_bounces && !(STORE_MODE == STORE_CAUSTIC && diffuse == 1.0)) {
        end_path(path, OUTCOME_TRUNCATED);
    } else {
        float choice = to_unit_float(random_bits(settings.seed, path.index, path.bounce, 5u));
        bool takes_diffuse = choice < diffuse;
        if (takes_diffuse) scatter_diffuse(path, surface, normal);
#ifdef HAS_MIRROR
        else if (choice < diffuse + weigh_mirror(surface.material)) scatter_mirror(path, surface);
#endif
#ifdef HAS_DIELECTRIC
        else interaction = scatter_dielectric(path, surface);
#endif
    }
    record_vertex(path, surface, normal, interaction, diffuse, arriving, stores);
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.chunk_size) return;
    uint slot = lane_order[gl_GlobalInvocationID.x];
    if (slot >= settings.count) return; // a shortened last chunk
    PathState path = start_path(settings.first + slot, slot);
    while (path.alive) {
        Hit hit = intersect_scene(path.ray, INFINITY, false);
        if (hit.t == INFINITY) {
            end_path(path, OUTCOME_ESCAPED);
            break;
        }
        meet_surface(path, load_surface(hit), hit.t);
        ++path.bounce;
    }
    finish_path(path);
}
