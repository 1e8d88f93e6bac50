// SPDX-License-Identifier: Apache-2.0
// Textures and vertex colors: what they make of a surface's material and normal.
// Inputs: textures (3 texels each), paints (3 texels a material), atlas, corner_coordinates and corner_colors (3 texels a
// triangle). Defines: HAS_TEXTURES, HAS_VERTEX_COLORS.
#ifdef HAS_VERTEX_COLORS
#pragma binding texel corner_colors

vec4 find_vertex_color(uint triangle, vec3 weights) {
    return weights.x * corner_colors_at(3u * triangle) + weights.y * corner_colors_at(3u * triangle + 1u) +
           weights.z * corner_colors_at(3u * triangle + 2u);
}
#endif

#ifdef HAS_TEXTURES
#pragma binding texel textures
#pragma binding texel paints
#pragma binding texel corner_coordinates
#pragma binding readonly uint atlas

// Index of a texel on one axis; `clamps`, `mirrors`: else it repeats.
uint wrap_texel(int at, int size, bool clamps, bool mirrors) {
    if (clamps) return uint(clamp(at, 0, size - 1));
    int period = mirrors ? 2 * size : size;
    int wrapped = at - (at >= 0 ? at / period : -((period - 1 - at) / period)) * period;
    return uint(clamp(wrapped < size ? wrapped : period - 1 - wrapped, 0, size - 1));
}

vec4 load_texel(uvec4 place, ivec2 at) {
    uint column = wrap_texel(at.x, int(place.y), (place.w & TEXTURE_CLAMP_U) != 0u, (place.w & TEXTURE_MIRROR_U) != 0u);
    uint row = wrap_texel(at.y, int(place.z), (place.w & TEXTURE_CLAMP_V) != 0u, (place.w & TEXTURE_MIRROR_V) != 0u);
    uint codes = atlas[place.x + row * place.y + column];
    if ((place.w & TEXTURE_SRGB) == 0u) return unpackUnorm4x8(codes);
    return vec4(uintBitsToFloat(atlas[codes & 0xffu]), uintBitsToFloat(atlas[codes >> 8u & 0xffu]),
                uintBitsToFloat(atlas[codes >> 16u & 0xffu]), float(codes >> 24u) / 255.0);
}

// Corner of a triangle in a texture's coordinates.
vec2 find_texture_corner(uint texture_index, uint triangle, uint corner) {
    vec4 coordinates = corner_coordinates_at(3u * triangle + corner);
    bool is_second = (floatBitsToUint(textures_at(3u * texture_index).w) & TEXTURE_SECOND_COORDINATES) != 0u;
    vec2 uv = is_second ? coordinates.zw : coordinates.xy;
    vec3 to_u = textures_at(3u * texture_index + 1u).xyz;
    vec3 to_v = textures_at(3u * texture_index + 2u).xyz;
    return vec2(to_u.x * uv.x + to_u.y * uv.y + to_u.z, to_v.x * uv.x + to_v.y * uv.y + to_v.z);
}

// Bilinear, or the nearest texel; `number` is an index + 1.
vec4 sample_texture(float number, uint triangle, vec3 weights) {
    uint index = uint(number) - 1u;
    uvec4 place = floatBitsToUint(textures_at(3u * index));
    vec2 uv = weights.x * find_texture_corner(index, triangle, 0u) + weights.y * find_texture_corner(index, triangle, 1u) +
              weights.z * find_texture_corner(index, triangle, 2u);
    // Whole periods come off first, so that far coordinates keep their digits.
    vec2 periods = vec2((place.w & TEXTURE_MIRROR_U) != 0u ? 2.0 : 1.0, (place.w & TEXTURE_MIRROR_V) != 0u ? 2.0 : 1.0);
    bvec2 clamps = bvec2((place.w & TEXTURE_CLAMP_U) != 0u, (place.w & TEXTURE_CLAMP_V) != 0u);
    uv = mix(uv - periods * floor(uv / periods), clamp(uv, vec2(-1.0), vec2(2.0)), clamps);
    vec2 at = uv * vec2(place.yz);
    if ((place.w & TEXTURE_NEAREST) != 0u) return load_texel(place, ivec2(floor(at)));
    vec2 base = floor(at - 0.5);
    vec2 part = at - 0.5 - base;
    ivec2 corner = ivec2(base);
    vec4 upper = mix(load_texel(place, corner), load_texel(place, corner + ivec2(1, 0)), part.x);
    vec4 lower = mix(load_texel(place, corner + ivec2(0, 1)), load_texel(place, corner + ivec2(1, 1)), part.x);
    return mix(upper, lower, part.y);
}

// Tangent-space normal of a texture: x along its u, y against its v (glTF 2.0, section 3.9.3), z along the shading normal.
vec3 bend_normal(vec3 normal, float number, float scale, uint triangle, vec3 weights, vec3 e1, vec3 e2) {
    uint index = uint(number) - 1u;
    vec2 corner = find_texture_corner(index, triangle, 0u);
    vec2 d1 = find_texture_corner(index, triangle, 1u) - corner;
    vec2 d2 = find_texture_corner(index, triangle, 2u) - corner;
    float turn = d1.x * d2.y - d2.x * d1.y < 0.0 ? -1.0 : 1.0;
    vec3 along_u = turn * (d2.y * e1 - d1.y * e2);
    vec3 along_v = turn * (d1.x * e2 - d2.x * e1);
    vec3 u = normalize_safely(along_u - dot(along_u, normal) * normal);
    if (u == vec3(0.0)) return normal;
    vec3 v = cross(normal, u);
    if (dot(v, along_v) > 0.0) v = -v;
    vec3 bent = 2.0 * sample_texture(number, triangle, weights).xyz - 1.0;
    vec3 turned = normalize_safely(scale * bent.x * u + scale * bent.y * v + bent.z * normal);
    return turned == vec3(0.0) ? normal : turned;
}

void paint_material(inout Material material, MaterialPaint paint, uint triangle, vec3 weights) {
    if (paint.colors.x > 0.0) {
        vec4 color = sample_texture(paint.colors.x, triangle, weights);
        material.base_color_metallic.rgb *= color.rgb;
        material.alpha.x *= color.a;
    }
    if (paint.colors.y > 0.0) {
        vec4 shine = sample_texture(paint.colors.y, triangle, weights);
        material.base_color_metallic.w *= shine.b;
        material.roughness_thin.x *= shine.g;
    }
    if (paint.colors.w > 0.0) material.emission_transmission.rgb *= sample_texture(paint.colors.w, triangle, weights).rgb;
    if (paint.others.x > 0.0) material.emission_transmission.w *= sample_texture(paint.others.x, triangle, weights).r;
#ifdef HAS_TRANSLUCENCY
    if (paint.others.z > 0.0) material.translucency.w *= sample_texture(paint.others.z, triangle, weights).a;
    if (paint.others.w > 0.0) material.translucency.rgb *= sample_texture(paint.others.w, triangle, weights).rgb;
#endif
#ifdef HAS_LAYERS
    if (paint.layers.x > 0.0) material.gloss *= sample_texture(paint.layers.x, triangle, weights).a;
    if (paint.layers.y > 0.0) material.gloss.rgb *= sample_texture(paint.layers.y, triangle, weights).rgb;
    if (paint.layers.z > 0.0) material.coat.x *= sample_texture(paint.layers.z, triangle, weights).r;
    if (paint.layers.w > 0.0) material.coat.y *= sample_texture(paint.layers.w, triangle, weights).g;
#endif
}
#endif
