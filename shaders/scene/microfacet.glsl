// SPDX-License-Identifier: Apache-2.0
// Rough surfaces: GGX microfacets with height-correlated Smith shadowing (Walter et al. 2007, Heitz 2014), sampled by
// the normals that are visible (Dupuy and Benyoub 2023). Single scattering: what facets block is absorbed.
// Directions lie in a frame whose z axis is the surface's normal on the arriving side; `arriving` points away from it.

// The width of the distribution; roughness is glTF's. The floor keeps its square a normal number, nothing else.
float find_ggx_width(float roughness) { return max(roughness * roughness, 1e-15); }

// Density of facets with unit normal m, per area and steradian.
float find_facet_density(vec3 m, float width) {
    float stretched = dot(m.xy / width, m.xy / width) + m.z * m.z;
    return 1.0 / (PI * width * width * stretched * stretched);
}

// Smith's Λ: facets hidden for each that is seen from w.
float find_hidden(vec3 w, float width) {
    float slope2 = dot(w.xy, w.xy) * width * width / max(w.z * w.z, 1e-30);
    return 0.5 * (sqrt(1.0 + slope2) - 1.0);
}

// Share of the facets seen from `arriving` that are seen from `leaving` too.
float share_visible(vec3 arriving, vec3 leaving, float width) {
    float hidden = find_hidden(arriving, width);
    return (1.0 + hidden) / (1.0 + hidden + find_hidden(leaving, width));
}

// A facet's normal among those visible from `arriving`; u in [0, 1)².
vec3 sample_visible_facet(vec3 arriving, float width, vec2 u) {
    vec3 stretched = normalize_safely(vec3(width * arriving.xy, arriving.z));
    float s, c;
    sin_cos(2.0 * PI * u.x, s, c);
    // Around the stretched direction the visible facets' mirror directions fill a cap of the sphere evenly.
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float sine = sqrt(max(0.0, (1.0 - z) * (1.0 + z)));
    vec3 halfway = vec3(sine * c, sine * s, z) + stretched;
    return normalize_safely(vec3(width * halfway.xy, max(halfway.z, 1e-30)));
}

// Density of sample_visible_facet, per steradian of m.
float find_visible_density(vec3 arriving, vec3 m, float width) {
    return find_facet_density(m, width) * max(0.0, dot(arriving, m)) / (arriving.z * (1.0 + find_hidden(arriving, width)));
}

// Steradians of facet normals for each of mirrored directions, and of refracted ones; `ratio`: index here over index
// beyond, `leaving` on the other side.
float measure_reflection(vec3 arriving, vec3 m) { return 1.0 / max(4.0 * abs(dot(arriving, m)), 1e-30); }

float measure_refraction(vec3 arriving, vec3 leaving, vec3 m, float ratio) {
    float across = ratio * dot(arriving, m) + dot(leaving, m);
    return abs(dot(leaving, m)) / max(across * across, 1e-30);
}

// The facet that refracts `arriving` to `leaving`, on the arriving side.
vec3 find_refracting_facet(vec3 arriving, vec3 leaving, float ratio) {
    vec3 m = normalize_safely(ratio * arriving + leaving);
    return m.z < 0.0 ? -m : m;
}
