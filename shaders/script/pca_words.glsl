// SPDX-License-Identifier: Apache-2.0
// Moments and decompositions that come from before the pass.

Moments load_uniform_moments(uint words) {
    Moments m;
    m.count = int(uniform_words[words]);
    m.first_photon = uniform_words[words + 1u];
    for (uint i = 0u; i < 3u; ++i) {
        m.first_point[i] = uintBitsToFloat(uniform_words[words + 2u + i]);
        m.mean[i] = uintBitsToFloat(uniform_words[words + 5u + i]);
    }
    m.diagonal.x = uintBitsToFloat(uniform_words[words + 8u]);
    m.mixed.x = uintBitsToFloat(uniform_words[words + 9u]);
    m.mixed.y = uintBitsToFloat(uniform_words[words + 10u]);
    m.diagonal.y = uintBitsToFloat(uniform_words[words + 11u]);
    m.mixed.z = uintBitsToFloat(uniform_words[words + 12u]);
    m.diagonal.z = uintBitsToFloat(uniform_words[words + 13u]);
    return m;
}

vec3 load_uniform_vector(uint words) {
    return uintBitsToFloat(uvec3(uniform_words[words], uniform_words[words + 1u], uniform_words[words + 2u]));
}
Decomposition load_uniform_decomposition(uint words) {
    return Decomposition(int(uniform_words[words]), load_uniform_vector(words + 1u), load_uniform_vector(words + 4u),
                         load_uniform_vector(words + 7u), load_uniform_vector(words + 10u),
                         load_uniform_vector(words + 13u));
}
