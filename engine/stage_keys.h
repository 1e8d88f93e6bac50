// SPDX-License-Identifier: Apache-2.0
// What each stage's result depends on.
#pragma once

#include "core/memo.h"
#include "estimate/render_image.h"
#include "known_photons.h"
#include "relax/settings.h"
#include "script/run/run_script.h"

namespace photonloupe {

MemoKey make_key(const Scene& scene, const TraceSettings& settings);
MemoKey make_key(const Photons& photons, const script::CompiledScript& script, const script::RunSettings& settings,
                 bool keeps);
MemoKey make_key(const Photons& photons, const Scene* surface, const RelaxSettings& settings);
MemoKey make_key(const Photons& photons, std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                 const EstimateSettings& settings);
MemoKey make_key(const Scene& scene, const Photons* photons, const CameraChoice& camera,
                 const RenderSettings& settings);

} // namespace photonloupe
