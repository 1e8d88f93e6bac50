// SPDX-License-Identifier: Apache-2.0
// A color in eight bits a channel, red in the low byte.

uint pack_color(vec4 color) {
    uvec4 bytes = uvec4(clamp(color, 0.0, 1.0) * 255.0 + 0.5);
    return bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24;
}
