// SPDX-License-Identifier: Apache-2.0
// The present photon's color, until its iteration ends.
#pragma binding writeonly vec4 colors

vec4 staged_color; // w: 1 where it was set

void write_color() {
    if (staged_color.w > 0.0) colors[photon] = staged_color;
}
