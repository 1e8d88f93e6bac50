// SPDX-License-Identifier: Apache-2.0
// The test for "the same surface" that estimates, constraints and repulsion share (METHODS §2).
#pragma once

namespace photonloupe {

// Largest height above the tangent plane as a share of r.
inline constexpr float SURFACE_FLATNESS = 0.1f;

} // namespace photonloupe
