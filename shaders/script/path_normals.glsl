// SPDX-License-Identifier: Apache-2.0
// Normals along photons' paths; w: how the vertex scatters. `vertex` is -1 for none.
#pragma binding texel path_normals

vec4 read_path_normal(uvec2 path, int vertex) {
    vec4 found = path_normals_at(path.x + uint(max(vertex, 0)));
    return vertex < 0 ? vec4(NAN) : found;
}
