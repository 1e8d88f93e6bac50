// SPDX-License-Identifier: Apache-2.0
// Moments over photons: a lane's running ones.

Moments load_moments(uint slot) {
    Moments m;
    m.count = load_integer(slot);
    m.first_photon = uint(load_integer(slot + 1u));
    m.first_point = vec3(load_real(slot + 2u), load_real(slot + 3u), load_real(slot + 4u));
    m.mean = vec3(load_real(slot + 5u), load_real(slot + 6u), load_real(slot + 7u));
    m.diagonal = vec3(load_real(slot + 8u), load_real(slot + 11u), load_real(slot + 13u));
    m.mixed = vec3(load_real(slot + 9u), load_real(slot + 10u), load_real(slot + 12u));
    return m;
}

void store_vector(uint slot, vec3 v) {
    store(slot, v.x);
    store(slot + 1u, v.y);
    store(slot + 2u, v.z);
}
void store_moments(uint slot, Moments m) {
    store(slot, m.count);
    store(slot + 1u, int(m.first_photon));
    store_vector(slot + 2u, m.first_point);
    store_vector(slot + 5u, m.mean);
    store(slot + 8u, m.diagonal.x);
    store(slot + 9u, m.mixed.x);
    store(slot + 10u, m.mixed.y);
    store(slot + 11u, m.diagonal.y);
    store(slot + 12u, m.mixed.z);
    store(slot + 13u, m.diagonal.z);
}
