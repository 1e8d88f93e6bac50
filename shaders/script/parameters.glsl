// SPDX-License-Identifier: Apache-2.0
// Photons' parameters: one column a dimension from 3 on, NaN where unset. `dimension` and `id` are -1 for none.
#pragma binding float parameter_columns

float read_parameter(int id, int dimension) {
    uint column = uint(max(dimension, 3) - 3);
    float found = parameter_columns[column * settings.photon_count + uint(max(id, 0))];
    return id < 0 || dimension < 0 || is_nan(found) ? NAN : found; // what is unset is a NaN of its own
}

// What the present photon sets, until its iteration ends.
float staged_parameters[13];
uint staged_mask; // bit d - 3

void stage_parameter(int dimension, float value) {
    if (dimension < 3) return;
    staged_parameters[dimension - 3] = value;
    staged_mask |= 1u << uint(dimension - 3);
}

float read_own_parameter(int dimension) {
    if (dimension < 3) return NAN;
    bool is_staged = (staged_mask >> uint(dimension - 3) & 1u) != 0u;
    return is_staged ? staged_parameters[dimension - 3] : read_parameter(photon, dimension);
}

void write_parameter(int dimension) {
    uint column = uint(dimension - 3);
    if ((staged_mask >> column & 1u) != 0u)
        parameter_columns[column * settings.photon_count + uint(photon)] = staged_parameters[column];
}
