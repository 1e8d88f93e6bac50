// SPDX-License-Identifier: Apache-2.0
// The scene as the kernels read it: triangles, shading normals, materials, lights and BVH nodes.
// Positions are metres relative to the scene's origin (Scene::origin), glTF axes (y up).
#ifndef PHOTONLOUPE_SHARED_SCENE_H
#define PHOTONLOUPE_SHARED_SCENE_H

#include "shared/types.h"

SHARED_BEGIN

// One triangle, counter-clockwise seen from its geometric normal's side.
// The w components hold uints as bits (floatBitsToUint).
struct Triangle {
    vec4 v0_object;   // xyz vertex 0, w object index
    vec4 v1_material; // xyz vertex 1, w material index
    vec4 v2_source;   // xyz vertex 2, w index of the triangle in its glTF primitive
};

// Unit shading normals at the three vertices; w unused (0).
struct TriangleNormals {
    vec4 n0;
    vec4 n1;
    vec4 n2;
};

// Mixture of Lambert, mirror and dielectric: weights (1-metallic)(1-transmission), metallic, (1-metallic)·transmission.
struct Material {
    vec4 base_color_metallic;   // rgb linear base colour, w metallic
    vec4 absorption_ior;        // rgb absorption coefficient of the interior in 1/m (Beer-Lambert), w index of refraction
    vec4 emission_transmission; // rgb emitted radiance W/(m² sr), w transmission
    vec4 roughness_thin;        // x roughness, y 1 = thin (no volume), zw unused
};

const uint LIGHT_POINT = 0u;

struct Light {
    vec4 position_kind; // xyz position, w kind as bits (LIGHT_POINT …)
    vec4 intensity;     // rgb radiant intensity in W/sr, w unused
};

// Entries of a traversal's stack; the builder keeps every tree shallower (BVH_MAX_DEPTH in engine/scene/bvh.h).
const uint BVH_STACK_SIZE = 64u;

// BVH2 node. Interior: count 0, children at first and first + 1. Leaf: triangles first … first + count - 1.
struct BvhNode {
    vec4 lo_first; // xyz lower corner, w first as bits
    vec4 hi_count; // xyz upper corner, w count as bits
};

// First texel of the scene's geometry buffer, before the nodes and the triangles.
struct SceneHeader {
    uint triangle_texels; // where the triangles begin
    uint pad0;
    uint pad1;
    uint pad2;
};

SHARED_END

#endif
