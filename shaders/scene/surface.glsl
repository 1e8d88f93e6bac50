// SPDX-License-Identifier: Apache-2.0
// The surface at a hit: position with its error bound, normals, material; and rays that leave it safely.
// Inputs: shading_normals (3 texels a triangle), materials (MATERIAL_TEXELS each), with textures and vertex colors what paints them.
// Defines: HAS_TEXTURES, HAS_VERTEX_COLORS, HAS_ALPHA, HAS_TRANSLUCENCY, HAS_LAYERS, HAS_DISPERSION.
#include "shared/math.glsl"
#include "scene/intersect.glsl"
#include "scene/paint.glsl"
#pragma binding texel shading_normals
#pragma binding texel materials

struct Surface {
    vec3 position;
    float error;            // metres: rays start this far off the surface
    vec3 geometric_normal;  // unit, on the side counter-clockwise triangles show
    vec3 smooth_normal;     // unit, as modelled: where photons are stored and looked for
    vec3 shading_normal;    // unit, the same or as a texture turns it: where light goes
    uint object;
    uint triangle;
    Material material;
};

Material load_material(uint index) {
    uint first = MATERIAL_TEXELS * index;
    Material material = Material(materials_at(first), materials_at(first + 1u), materials_at(first + 2u), materials_at(first + 3u),
                                 vec4(1.0, ALPHA_OPAQUE, 0.0, 0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
#if defined(HAS_ALPHA) || defined(HAS_DISPERSION)
    material.alpha = materials_at(first + 4u);
#endif
#ifdef HAS_TRANSLUCENCY
    material.translucency = materials_at(first + 5u);
#endif
#ifdef HAS_LAYERS
    material.gloss = materials_at(first + 6u);
    material.coat = materials_at(first + 7u);
#endif
    return material;
}

Surface load_surface(Hit hit) {
    vec4 v0 = load_corner(hit.triangle, 0u);
    vec4 v1 = load_corner(hit.triangle, 1u);
    vec4 v2 = load_corner(hit.triangle, 2u);
    vec3 weights = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    Surface surface;
    surface.position = weights.x * v0.xyz + weights.y * v1.xyz + weights.z * v2.xyz;
    vec3 reach = max(abs(v0.xyz), max(abs(v1.xyz), abs(v2.xyz)));
    surface.error = POSITION_ERROR * max(reach.x, max(reach.y, reach.z));
    // Edges are brought to unit size first: the product of tiny ones would underflow.
    vec3 e1 = v1.xyz - v0.xyz;
    vec3 e2 = v2.xyz - v0.xyz;
    float s1 = max(abs(e1.x), max(abs(e1.y), abs(e1.z)));
    float s2 = max(abs(e2.x), max(abs(e2.y), abs(e2.z)));
    surface.geometric_normal = normalize_safely(cross(e1 / s1, e2 / s2));
    vec3 n = weights.x * shading_normals_at(3u * hit.triangle).xyz +
             weights.y * shading_normals_at(3u * hit.triangle + 1u).xyz +
             weights.z * shading_normals_at(3u * hit.triangle + 2u).xyz;
    surface.smooth_normal = normalize_safely(n);
    if (surface.smooth_normal == vec3(0.0)) surface.smooth_normal = surface.geometric_normal;
    surface.shading_normal = surface.smooth_normal;
    surface.object = floatBitsToUint(v0.w);
    surface.triangle = hit.triangle;
    uint material = floatBitsToUint(v1.w);
    surface.material = load_material(material);
#ifdef HAS_VERTEX_COLORS
    vec4 color = find_vertex_color(hit.triangle, weights);
    surface.material.base_color_metallic.rgb *= color.rgb;
    surface.material.alpha.x *= color.a;
#endif
#ifdef HAS_TEXTURES
    MaterialPaint paint = MaterialPaint(paints_at(PAINT_TEXELS * material), paints_at(PAINT_TEXELS * material + 1u),
                                        paints_at(PAINT_TEXELS * material + 2u));
    paint_material(surface.material, paint, hit.triangle, weights);
    if (paint.colors.z > 0.0)
        surface.shading_normal =
            bend_normal(surface.smooth_normal, paint.colors.z, paint.others.y, hit.triangle, weights, e1 / max(s1, s2), e2 / max(s1, s2));
#endif
    return surface;
}

// A ray that starts off the surface by the bound on all rounding involved, on the side it leaves to.
Ray leave_surface(Surface surface, vec3 direction) {
    float side = dot(direction, surface.geometric_normal) < 0.0 ? -surface.error : surface.error;
    return Ray(surface.position + side * surface.geometric_normal, direction);
}
