// SPDX-License-Identifier: Apache-2.0
// A linear color per photon or cell, for whoever draws them.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "inspect/colormap.h"
#include "inspect/column.h"
#include "photons/photon_map.h"

namespace photonloupe::inspect {

// Linear light of an sRGB channel or color.
float linearize(float srgb);
glm::vec3 linearize(const glm::vec3& srgb);

// Luminance of linear Rec. 709, as shaders/estimate/luminance.glsl has it.
inline float find_luminance(const glm::vec3& rgb) {
    return 0.2126f * rgb.r + 0.7152f * rgb.g + 0.0722f * rgb.b;
}

// Of a number: the same on every run, neighbours apart.
glm::vec3 hash_color(std::uint32_t id);
std::vector<glm::vec3> list_hash_colors(std::uint64_t count);

// The false colors that a script gave (grey where it did not), else those of the ids.
std::vector<glm::vec3> list_encoded_colors(const PhotonMap& photons);

// Twilight for what repeats, cividis for the rest.
Colormap choose_colormap(const Column& column);
// Place of a value in a color map: periodic columns over their period, others over low … high. NaN for NaN.
float find_color_share(const Column& column, float value);
std::vector<glm::vec3> list_column_colors(const Column& column);

} // namespace photonloupe::inspect
