// SPDX-License-Identifier: Apache-2.0
// Photons' positions in the world, and emitters.
#pragma binding texel position_emitter

vec4 read_position(int id) {
    vec4 found = position_emitter_at(max(id, 0));
    found.xyz += settings.origin.xyz;
    return id < 0 ? vec4(NAN) : found;
}

int read_emitter(int id) { return id < 0 ? 0 : int(floatBitsToUint(position_emitter_at(max(id, 0)).w)); }
