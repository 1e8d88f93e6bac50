// SPDX-License-Identifier: Apache-2.0
// Photons' normals.
#pragma binding texel normal_index

vec4 read_normal(int id) {
    vec4 found = normal_index_at(max(id, 0));
    return id < 0 ? vec4(NAN) : found;
}
