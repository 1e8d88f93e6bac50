// SPDX-License-Identifier: Apache-2.0
// One path on its way: what it carries, what it has deposited, and how its vertices go to the scratch slots.

struct PathState {
    uint index;   // emitted index
    uint slot;    // place in the chunk
    uint light;
    Ray ray;
    vec3 flux;    // W, times the number emitted
    uint bounce;
    bool alive;
    bool met_specular;
    bool met_diffuse;
#ifdef HAS_MEDIA
    Media media;  // that the ray is in
#endif
    float band;   // place in the spectrum, in [0, 1); negative: white light
    uint outcome;
    vec3 deposited; // sum over events of flux in - out
    vec3 lost;      // flux carried away when escaped or truncated
    uint recorded;  // scratch slots used
    uint vertex_count;
    uint photon_count;
    uint photon_vertex_count;
};

uint locate_scratch(PathState path) { return path.recorded * settings.chunk_size + path.slot; }

// Ends the path; flux that did not end on a surface is lost, the rest was deposited.
void end_path(inout PathState path, uint outcome) {
    path.alive = false;
    path.outcome = outcome;
    if (outcome == OUTCOME_ESCAPED || outcome == OUTCOME_TRUNCATED) path.lost = path.flux;
    else path.deposited += path.flux;
    path.flux = vec3(0.0);
}

// Russian roulette on a coloured factor: survives with its largest channel, so that stored fluxes stay nearly equal.
bool survive(inout PathState path, vec3 factor, uint random) {
    float chance = max(factor.r, max(factor.g, factor.b));
    if (chance >= 1.0 || to_unit_float(random) < chance) {
        vec3 leaving = path.flux * factor / max(min(chance, 1.0), 1e-30);
        path.deposited += path.flux - leaving;
        path.flux = leaving;
        return true;
    }
    end_path(path, OUTCOME_ABSORBED);
    return false;
}

#ifdef HAS_MEDIA
void weigh_flux(inout PathState path, vec3 weight) {
    vec3 leaving = path.flux * weight;
    path.deposited += path.flux - leaving;
    path.flux = leaving;
}

// Russian roulette that keeps the sum of the channels, as flights in media do.
bool survive_in_sum(inout PathState path, vec3 factor, uint random) {
    vec3 leaving = path.flux * factor;
    float chance = (leaving.r + leaving.g + leaving.b) / max(path.flux.r + path.flux.g + path.flux.b, 1e-37);
    if (to_unit_float(random) < chance) {
        weigh_flux(path, factor / chance);
        return true;
    }
    end_path(path, OUTCOME_ABSORBED);
    return false;
}
#endif

bool is_stored(PathState path) {
#if STORE_MODE == 0 // STORE_CAUSTIC
    return path.met_specular && !path.met_diffuse;
#elif STORE_MODE == 1 // STORE_INDIRECT
    return path.met_specular || path.met_diffuse;
#else // STORE_ALL
    return true;
#endif
}

void write_vertex(inout PathState path, vec3 position, uint interaction, uint object, vec3 normal, float scatter,
                  vec3 power, bool stores) {
    uint at = locate_scratch(path);
    scratch_position[at] = vec4(position, uintBitsToFloat(interaction << 24u | object));
    scratch_normal[at] = vec4(normal, scatter);
    scratch_power[at] = vec4(power, stores ? 1.0 : 0.0);
    ++path.recorded;
}

void record_vertex(inout PathState path, vec3 position, uint object, vec3 normal, uint interaction, float scatter,
                   vec3 arriving, bool stores) {
    ++path.vertex_count;
    if (stores) {
        ++path.photon_count;
        path.photon_vertex_count += path.vertex_count;
    }
#ifndef RECORD_PATHS
    if (!stores) return;
#endif
    // Scatter: 0 mirror-like … 1 diffuse; roughness and mixtures lie between.
    write_vertex(path, position, interaction, object, normal, scatter, arriving, stores);
}

PathState start_path(uint index, uint slot) {
    Emission emission = emit_photon(index);
    PathState path;
    path.index = index;
    path.slot = slot;
    path.light = emission.light;
    path.ray = Ray(emission.origin, emission.direction);
    path.flux = emission.flux;
    path.bounce = 0u;
    path.alive = true;
    path.met_specular = false;
    path.met_diffuse = false;
#ifdef HAS_MEDIA
    path.media = Media(floatBitsToUint(emitters[emission.light].u_axis.w), floatBitsToUint(emitters[emission.light].v_axis.w));
#endif
    path.band = -1.0;
    path.outcome = OUTCOME_ABSORBED;
    path.deposited = vec3(0.0);
    path.lost = vec3(0.0);
    path.recorded = 0u;
    path.vertex_count = 1u;
    path.photon_count = 0u;
    path.photon_vertex_count = 0u;
#ifdef HAS_COLORED_EMISSION
    emitted_flux[slot] = vec4(emission.flux, 0.0);
#endif
#ifdef RECORD_PATHS
    write_vertex(path, emission.origin, INTERACTION_END, NO_OBJECT, emission.normal, 0.0, emission.flux, false);
#endif
    return path;
}

void finish_path(PathState path) {
    summaries[path.slot] = PathSummary(path.outcome | path.light << 8u, path.recorded, path.photon_count, path.photon_vertex_count);
    deposited_flux[path.slot] = vec4(path.deposited, 0.0);
    lost_flux[path.slot] = vec4(path.lost, 0.0);
}
