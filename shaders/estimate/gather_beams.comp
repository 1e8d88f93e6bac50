// SPDX-License-Identifier: Apache-2.0
// Radiance that photons in media send along stretches of eye paths: beam × point (METHODS §13).
// Inputs: scene, the tree, photon_light (tree order: rgb scattered flux in W, w bits: object), photon_radii (tree
// order, metres), node_reaches (by heap index: the largest radius below), beam_origin (xyz, w length; 0: none),
// beam_direction (xyz, w bits: boundary of the medium + 1). In and out: beam_cursor (the node to go on with, 0: done),
// beam_radiance. Define HAS_MEDIA.
#include "shared/prelude.glsl"
#include "shared/random.h"
#include "shared/render.h"
#include "scene/scatter.glsl"
#include "photons/tree_texels.glsl"
#pragma binding texel tree_normals
#pragma binding texel photon_light
#pragma binding readonly float photon_radii
#pragma binding readonly float node_reaches
#pragma binding texel beam_origin
#pragma binding texel beam_direction
#pragma binding uint beam_cursor
#pragma binding vec4 beam_radiance

layout(push_constant) uniform Push { BeamSettings settings; };

struct EyeBeam {
    vec3 origin, direction;
    float end; // metres
    Medium medium;
};

// Whether the beam comes as near to the node's box as a photon in it reaches.
bool meets_node(EyeBeam beam, vec3 inverse, uint node) {
    vec3 reach = vec3(node_reaches[node]);
    return enter_box(tree_nodes_at(2u * node).xyz - reach, tree_nodes_at(2u * node + 1u).xyz + reach, beam.origin, inverse,
                     beam.end) < INFINITY;
}

// A disc across the beam about the photon, weighed by Epanechnikov's kernel.
vec3 meet_photon(EyeBeam beam, uint position) {
    vec3 offset = tree_positions_at(position).xyz - beam.origin;
    float along = dot(offset, beam.direction);
    vec3 aside = offset - along * beam.direction;
    float radius = photon_radii[position];
    float s = dot(aside, aside) / (radius * radius);
    vec4 light = photon_light_at(position);
    if (along <= 0.0 || along >= beam.end || s >= 1.0 || floatBitsToUint(light.w) != beam.medium.object) return vec3(0.0);
    // The normal is the way back, the eye looks against where light goes.
    float cosine = dot(normalize_safely(tree_normals_at(position).xyz), beam.direction);
    return light.rgb * transmit(beam.medium.extinction, along) *
           (find_phase(beam.medium.anisotropy, cosine) * 2.0 * (1.0 - s) / (PI * radius * radius));
}

vec3 meet_leaf(EyeBeam beam, uint node) {
    uint leaf = node - (1u << settings.leaf_level);
    uint end = find_first_position(settings.photon_count, leaf + 1u, settings.leaf_level);
    vec3 sum = vec3(0.0);
    for (uint position = find_first_position(settings.photon_count, leaf, settings.leaf_level); position < end; ++position) {
        ++turns;
        sum += meet_photon(beam, position);
    }
    return sum;
}

// The next node of a walk that does not enter this one; 0: none.
uint pass_node(uint node) {
    uint up = node >> uint(findLSB(~node)); // out of all right children
    return up == 0u ? 0u : up + 1u;
}

void main() {
    if (gl_GlobalInvocationID.x >= settings.count) return;
    uint at = settings.first + gl_GlobalInvocationID.x;
    vec4 origin = beam_origin_at(at), direction = beam_direction_at(at);
    uint node = origin.w > 0.0 ? beam_cursor[at] : 0u;
    if (node == 0u) {
        beam_cursor[at] = 0u;
        return;
    }
    EyeBeam beam = EyeBeam(origin.xyz, direction.xyz, origin.w, load_medium(floatBitsToUint(direction.w)));
    vec3 inverse = invert_direction(beam.direction);
    vec3 sum = beam_radiance[at].rgb;
    while (node != 0u && has_turns_left()) {
        ++turns;
        bool is_leaf = node >> settings.leaf_level != 0u;
        bool is_met = meets_node(beam, inverse, node);
        if (is_met && is_leaf) sum += meet_leaf(beam, node);
        node = is_met && !is_leaf ? 2u * node : pass_node(node);
    }
    beam_radiance[at] = vec4(sum, 0.0);
    beam_cursor[at] = node;
}
