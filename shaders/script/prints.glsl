// SPDX-License-Identifier: Apache-2.0
// Marks photons that print; the host writes their lines.
#pragma binding uint print_bits

bool has_printed;

void mark_print() {
    if (has_printed) atomicOr(print_bits[uint(photon) >> 5u], 1u << (uint(photon) & 31u));
}
