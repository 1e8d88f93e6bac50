// SPDX-License-Identifier: Apache-2.0
// Vertices of photons' paths, in the world; what they lie on and what happened there. `vertex` is -1 for none.
#pragma binding texel path_vertices

const uint OBJECT_BITS = 0xffffffu; // all set: no object (shared/trace.h)

vec4 read_vertex(uvec2 path, int vertex) {
    vec4 found = path_vertices_at(path.x + uint(max(vertex, 0)));
    found.xyz += settings.origin.xyz;
    return vertex < 0 ? vec4(NAN) : found;
}

uint read_vertex_bits(uvec2 path, int vertex) {
    return floatBitsToUint(path_vertices_at(path.x + uint(max(vertex, 0))).w);
}
int read_interaction(uvec2 path, int vertex) {
    return vertex < 0 ? 0 : int(read_vertex_bits(path, vertex) >> 24u);
}
int read_object(uvec2 path, int vertex) {
    uint object = read_vertex_bits(path, vertex) & OBJECT_BITS;
    return vertex < 0 ? 0 : object == OBJECT_BITS ? -1 : int(object);
}
