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

// Mixture of Lambert, mirror and dielectric: weights (1-metallic)(1-transmission), metallic, (1-metallic)·transmission;
// under a coat, and a gloss over Lambert, where there are.
struct Material {
    vec4 base_color_metallic;   // rgb linear base colour, w metallic
    vec4 absorption_ior;        // rgb absorption coefficient of the interior in 1/m (Beer-Lambert), w index of refraction
    vec4 emission_transmission; // rgb emitted radiance W/(m² sr), w transmission
    vec4 roughness_thin;        // x roughness, y 1 = thin (no volume), z 1 = two-sided (emission), w unused
    vec4 alpha;                 // x alpha, y ALPHA_*, z least alpha that is there (ALPHA_MASK), w dispersion: 20 / Abbe number
    vec4 translucency;          // rgb colour of diffuse light that passes, w its share of all diffuse light
    vec4 gloss;                 // of a lobe over Lambert: rgb reflectance straight on, w at grazing angles; black: none
    vec4 coat;                  // x share that is coated, y the coat's roughness, zw unused
    vec4 medium;                // of the interior: rgb scattering coefficient in 1/m, w anisotropy: mean cosine of the angle
};

const uint MATERIAL_TEXELS = 9u;

// Media a ray may be in at once: the innermost and the one around it.
struct Media {
    uint inner;  // a triangle of its boundary + 1; 0: none
    uint around;
};

const float ALPHA_OPAQUE = 0.0f;
const float ALPHA_MASK = 1.0f;  // there or not
const float ALPHA_BLEND = 2.0f; // there with this probability

// An image on a surface: where its texels lie in the atlas, 4 bytes each, and how coordinates lead to them.
struct Texture {
    uvec4 place; // x first texel, y width, z height, w TEXTURE_* bits
    vec4 to_u;   // u of the image = x u + y v + z; w unused
    vec4 to_v;   // v of the image = x u + y v + z; w unused
};

const uint TEXTURE_NEAREST = 1u;
const uint TEXTURE_SECOND_COORDINATES = 2u; // TEXCOORD_1
const uint TEXTURE_SRGB = 4u;               // red, green and blue go through the atlas's table
const uint TEXTURE_CLAMP_U = 8u;            // else repeated
const uint TEXTURE_MIRROR_U = 16u;
const uint TEXTURE_CLAMP_V = 32u;
const uint TEXTURE_MIRROR_V = 64u;

// The atlas begins with the linear values of sRGB's 256 codes, as bits of floats.
const uint ATLAS_TABLE_SIZE = 256u;

// What paints a material: indices of textures + 1, 0 where there is none, exact in floats.
struct MaterialPaint {
    vec4 colors; // x base colour, y metallic-roughness, z normal, w emission
    vec4 others; // x transmission, y scale of the normal texture, z translucency's share, w its colour
    vec4 layers; // x gloss, y its colour, z coat, w its roughness
};

const uint PAINT_TEXELS = 3u;

// At the corners of a triangle.
struct CornerCoordinates {
    vec4 c0; // xy TEXCOORD_0, zw TEXCOORD_1
    vec4 c1;
    vec4 c2;
};

struct CornerColors {
    vec4 c0; // rgb linear, w alpha
    vec4 c1;
    vec4 c2;
};

const uint LIGHT_POINT = 0u;
const uint LIGHT_SPOT = 1u;
const uint LIGHT_DIRECTIONAL = 2u;
const uint LIGHT_AREA = 3u;
const uint LIGHT_ENVIRONMENT = 4u; // from all around

struct Light {
    vec4 position_kind; // xyz position (area: the middle), w kind as bits (LIGHT_POINT …)
    vec4 intensity;     // rgb radiant intensity in W/sr; directional: irradiance, W/m²; area, environment: radiance, W/(m² sr), of an image its mean; w: mean of the image's largest channel
    vec4 direction;     // xyz unit, where a spot or directional light shines; w unused
    vec4 cone;          // spot: 1 - cos of the inner and the outer angle; area: m², first emitting triangle and their number as bits, sides that shine; environment: x 1: an image says it
};

// A triangle of an area light, or a part of one that a texture lights unevenly.
struct EmittingTriangle {
    vec4 v0_cumulative; // xyz vertex 0, w share of the light's power up to and with this one
    vec4 v1;            // xyz vertex 1, w unused
    vec4 v2;            // xyz vertex 2, w unused
    vec4 tint;          // rgb its radiance over its largest channel, over the same of the light's mean; w unused
};

const uint EMITTING_TEXELS = 4u;

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

// First texel of an environment's image (shaders/scene/environment.glsl).
struct EnvironmentHeader {
    uint width;
    uint height;
    float turn;  // azimuth of the first column, as a share of a turn
    float whole; // of the largest channel's radiance over all directions, W/m²
};

// Cumulative shares are fractions of this many bits: as floats they are neither infinite nor NaN.
const uint ENVIRONMENT_FRACTION_BITS = 30u;

SHARED_END

#endif
