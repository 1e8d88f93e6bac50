// SPDX-License-Identifier: Apache-2.0
// Luminance of linear Rec. 709.

float find_luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }
