// SPDX-License-Identifier: Apache-2.0
// A component by a number that is computed; `axis` is -1 for none.

float pick_axis(vec4 v, int axis) { return axis < 0 ? NAN : axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
