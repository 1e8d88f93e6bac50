// SPDX-License-Identifier: Apache-2.0
// Photons' flux.
#pragma binding texel power_object

vec4 read_power(int id) {
    vec4 found = power_object_at(max(id, 0));
    return id < 0 ? vec4(NAN) : found;
}
