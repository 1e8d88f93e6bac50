// SPDX-License-Identifier: Apache-2.0
// Writes settings out, one after the other.
#include "stage_keys.h"

#include "core/hash.h"

namespace photonloupe {
namespace {

template <class Choice>
int number(Choice choice) {
    return static_cast<int>(choice);
}

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
    return MemoKey(scene.hash, settings.count, settings.emitted, settings.seed, number(settings.emission),
                   number(settings.store), settings.max_bounces, settings.paths);
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
    const ConstraintSettings& constraint = settings.constraint;
    MemoKey key(surface ? surface->hash : "", settings.steps, settings.neighbors, write_all(settings.over_relaxation),
                settings.limit, number(settings.repel), settings.beta, number(settings.search), settings.diffuse_flux,
                write_all(settings.period), number(constraint.descriptor), number(constraint.space),
                constraint.neighbors, constraint.beta, constraint.free_at, constraint.fixed_at);
    return add_photons(key, photons);
}

MemoKey make_key(const Photons& photons, std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                 const EstimateSettings& settings) {
    MemoKey key(hash_points(points), hash_points(normals), settings.k, number(settings.kernel), settings.flatness);
    return key.add(photons.identity);
}

MemoKey make_key(const Scene& scene, const Photons* photons, const RenderSettings& settings) {
    std::string placed;
    if (const std::optional<Camera>& camera = settings.camera.placed) {
        for (const auto& vector : {camera->position, camera->right, camera->up, camera->backward})
            placed += write_all(vector);
        placed += write_all(std::array{camera->yfov, camera->aspect});
    }
    MemoKey key(scene.hash, settings.camera.name, placed, settings.width, settings.height, settings.samples,
                number(settings.mode), settings.estimate.k, number(settings.estimate.kernel),
                settings.estimate.flatness, settings.seed, settings.max_bounces);
    return photons ? add_photons(key, *photons) : key;
}

} // namespace photonloupe
