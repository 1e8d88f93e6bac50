// SPDX-License-Identifier: Apache-2.0
// Writes inputs out, one after the other.
#include "stage_keys.h"

#include "core/hash.h"
#include "core/settings.h"

namespace photonloupe {
namespace {

template <class Values>
std::string write_all(const Values& values) {
    std::ostringstream text;
    text << std::hexfloat;
    for (const auto& value : values)
        text << value << ' ';
    return text.str();
}

std::string hash_points(std::span<const glm::vec4> points) {
    return hash_bytes({reinterpret_cast<const char*>(points.data()), points.size_bytes()});
}

MemoKey& add_photons(MemoKey& key, const Photons& photons) {
    return key.add(photons.identity)
        .add(photons.map.parameters ? photons.map.parameters->given : nullptr)
        .add(photons.map.given_colors);
}

} // namespace

MemoKey make_key(const Scene& scene, const TraceSettings& settings) {
    return MemoKey(scene.hash, write_settings(settings), settings.paths);
}

MemoKey make_key(const Photons& photons, const script::CompiledScript& script, const script::RunSettings& settings,
                 bool keeps) {
    std::string values;
    for (const auto& [name, value] : settings.values)
        values += name + '=' + write_all(std::array{value});
    MemoKey key(hash_bytes(script.program.source.text), values, settings.seed, settings.fuel, settings.most_exhausted,
                settings.most_seconds, keeps);
    return keeps ? add_photons(key, photons) : key.add(photons.identity);
}

MemoKey make_key(const Photons& photons, const Scene* surface, const RelaxSettings& settings) {
    MemoKey key(surface ? surface->hash : "", write_settings(settings));
    return add_photons(key, photons);
}

MemoKey make_key(const Photons& photons, std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                 const EstimateSettings& settings) {
    MemoKey key(hash_points(points), hash_points(normals), write_settings(settings));
    return key.add(photons.identity);
}

MemoKey make_key(const Scene& scene, const Photons* photons, const CameraChoice& choice,
                 const RenderSettings& settings) {
    std::string placed;
    if (const std::optional<Camera>& camera = choice.placed) {
        for (const auto& vector : {camera->position, camera->right, camera->up, camera->backward})
            placed += write_all(vector);
        placed += write_all(std::array{camera->yfov, camera->aspect});
    }
    MemoKey key(scene.hash, choice.name, placed, write_settings(settings));
    return photons ? add_photons(key, *photons) : key;
}

} // namespace photonloupe
