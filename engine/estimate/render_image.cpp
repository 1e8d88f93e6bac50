// SPDX-License-Identifier: Apache-2.0
// Renders in chunks of whole pixels: eye paths, direct light, irradiance at what they see, film.
#include "estimate/render_image.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>

#include "core/settings.h"
#include "estimate/camera_frame.h"
#include "estimate/eye_beams.h"
#include "estimate/plot_photons.h"
#include "gpu/commands.h"
#include "photons/map_columns.h"
#include "scene/find_media.h"

namespace photonloupe {
namespace {

// Diffuse hits one sample may have where paths split: what glass reflects and transmits, what lies on both sides of a
// leaf and under a gloss.
constexpr std::uint32_t SPLIT_SLOTS = 4;
// Slots of one chunk: a software device follows their rays in a tenth of a second, which Ctrl-C waits for.
constexpr std::uint64_t CHUNK_SLOTS = 1ull << 17;

gpu::KernelSource name_eye_kernel(const Scene& scene) {
    std::vector<std::string> defines = list_scene_defines(scene);
    if (scene.report.has_rough) // it shows lights
        for (std::string& define : list_light_defines(scene))
            defines.push_back(std::move(define));
    else if (scene.environment)
        defines.emplace_back("HAS_ENVIRONMENT_MAP");
    return {"estimate/trace_eye.comp", 64, std::move(defines), {}};
}

gpu::KernelSource name_light_kernel(const Scene& scene) {
    gpu::KernelSource kernel{"estimate/light_direct.comp", 64, list_light_defines(scene), {}};
    for (std::string& define : list_passing_defines(scene))
        kernel.defines.push_back(std::move(define));
    return kernel;
}

gpu::KernelSource name_beam_light_kernel(const Scene& scene) {
    gpu::KernelSource kernel{"estimate/light_beams.comp", 64, list_scene_defines(scene), {}};
    for (std::string& define : list_light_defines(scene))
        kernel.defines.push_back(std::move(define));
    return kernel;
}

gpu::KernelSource name_color_kernel() {
    return {"estimate/color_irradiance.comp", 64, {}, {}};
}

gpu::KernelSource name_film_kernel(const Scene& scene) {
    gpu::KernelSource kernel{"estimate/accumulate_film.comp", 64, {}, {}};
    if (scene.report.has_media)
        kernel.defines.emplace_back("HAS_MEDIA");
    return kernel;
}

// Which parts of light an image is made of.
struct Parts {
    bool emission, map, colors, direct;
};

Parts choose_parts(RenderMode mode, Store store) {
    const bool is_composite = mode == RenderMode::composite, is_colored = mode == RenderMode::false_color;
    return {mode != RenderMode::caustic && !is_colored, mode == RenderMode::caustic || is_composite || is_colored,
            is_colored, mode == RenderMode::direct || (is_composite && store != Store::all)};
}

struct FilmScratch {
    gpu::Buffer hit_point;
    gpu::Buffer hit_normal;
    gpu::Buffer hit_weight;
    gpu::Buffer eye_emission;
    gpu::Buffer direct_irradiance;
    gpu::Buffer slots; // 0, 1, 2 …
    EyeBeams beams;
};

FilmScratch allocate_scratch(gpu::Device& device, std::uint64_t samples, std::uint64_t slots, std::uint64_t beams) {
    const std::uint64_t bytes = samples * slots * sizeof(glm::vec4);
    std::vector<std::uint32_t> numbers(samples * slots);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return {
        gpu::Buffer(device, bytes, "eye hits"),     gpu::Buffer(device, bytes, "eye hits"),
        gpu::Buffer(device, bytes, "eye hits"),     gpu::Buffer(device, samples * sizeof(glm::vec4), "eye emission"),
        gpu::Buffer(device, bytes, "direct light"), gpu::make_buffer(device, numbers, "eye hits"),
        allocate_beams(device, samples * beams)};
}

struct Renderer {
    gpu::Device& device;
    const Scene& scene;
    const SceneBuffers& buffers;
    const RenderedMap* map;
    const RenderSettings& settings;
    shared::EyeSettings eye{};
    shared::FilmSettings film_push{};
    gpu::Buffer film;
    MediaLight media; // of the map, where there are media

    void trace_eye(const FilmScratch& scratch);
    void light_direct(const FilmScratch& scratch);
    void light_media(const FilmScratch& scratch, const Progress& progress);
    gpu::Buffer gather(const FilmScratch& scratch, const gpu::Buffer& power, const Progress& progress);
    void color(const FilmScratch& scratch, const gpu::Buffer& irradiance, const Progress& progress);
    void accumulate(const FilmScratch& scratch, const gpu::Buffer& irradiance);
    void render_chunk(const FilmScratch& scratch, const Progress& progress);
    Image run(const Progress& progress);
};

void Renderer::trace_eye(const FilmScratch& scratch) {
    gpu::dispatch(device, "trace eye paths", name_eye_kernel(scene),
                  buffers.bind({{"hit_point", scratch.hit_point},
                                {"hit_normal", scratch.hit_normal},
                                {"hit_weight", scratch.hit_weight},
                                {"eye_emission", scratch.eye_emission},
                                {"beam_origin", scratch.beams.origin},
                                {"beam_direction", scratch.beams.direction},
                                {"beam_weight", scratch.beams.weight}}),
                  eye, eye.sample_count);
}

void Renderer::light_direct(const FilmScratch& scratch) {
    gpu::dispatch(device, "light directly", name_light_kernel(scene),
                  buffers.bind({{"hit_point", scratch.hit_point},
                                {"hit_normal", scratch.hit_normal},
                                {"hit_weight", scratch.hit_weight},
                                {"direct_irradiance", scratch.direct_irradiance}}),
                  film_push, std::uint64_t{film_push.sample_count} * film_push.slot_count);
}

void Renderer::light_media(const FilmScratch& scratch, const Progress& progress) {
    const std::uint64_t count = std::uint64_t{film_push.sample_count} * film_push.beam_count;
    gather_beams(device, scene, buffers, media, scratch.beams, count, progress);
    if (film_push.uses_direct)
        gpu::dispatch(device, "light media", name_beam_light_kernel(scene),
                      buffers.bind({{"beam_origin", scratch.beams.origin},
                                    {"beam_direction", scratch.beams.direction},
                                    {"beam_radiance", scratch.beams.radiance}}),
                      film_push, count);
}

gpu::Buffer Renderer::gather(const FilmScratch& scratch, const gpu::Buffer& power, const Progress& progress) {
    const std::uint64_t slots = std::uint64_t{film_push.sample_count} * film_push.slot_count;
    return estimate_irradiance(device, power, map->tree,
                               {scratch.hit_point, scratch.hit_normal, slots, settings.samples}, scratch.slots,
                               settings.estimate, progress);
}

void Renderer::color(const FilmScratch& scratch, const gpu::Buffer& irradiance, const Progress& progress) {
    const gpu::Buffer sums = gather(scratch, *map->photons.colors, progress);
    gpu::dispatch(device, "color irradiance", name_color_kernel(), {{"color_sums", sums}, {"irradiance", irradiance}},
                  film_push, std::uint64_t{film_push.sample_count} * film_push.slot_count);
}

void Renderer::accumulate(const FilmScratch& scratch, const gpu::Buffer& irradiance) {
    gpu::dispatch(device, "accumulate film", name_film_kernel(scene),
                  {{"hit_weight", scratch.hit_weight},
                   {"direct_irradiance", scratch.direct_irradiance},
                   {"map_irradiance", irradiance},
                   {"eye_emission", scratch.eye_emission},
                   {"beam_weight", scratch.beams.weight},
                   {"beam_radiance", scratch.beams.radiance},
                   {"film", film}},
                  film_push, film_push.pixel_count);
}

void Renderer::render_chunk(const FilmScratch& scratch, const Progress& progress) {
    trace_eye(scratch);
    if (film_push.uses_direct)
        light_direct(scratch);
    const gpu::Buffer irradiance = film_push.uses_map ? gather(scratch, map->photons.power_object, progress)
                                                      : gpu::Buffer(device, sizeof(glm::vec4), "no irradiance");
    if (film_push.uses_colors)
        color(scratch, irradiance, progress);
    if (scene.report.has_media)
        light_media(scratch, progress);
    accumulate(scratch, irradiance);
}

Image Renderer::run(const Progress& progress) {
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    film = gpu::Buffer(device, pixels * sizeof(glm::vec4), "film");
    const std::uint64_t per_chunk =
        std::max<std::uint64_t>(1, CHUNK_SLOTS / (std::uint64_t{settings.samples} * film_push.slot_count));
    const FilmScratch scratch = allocate_scratch(device, std::min(per_chunk, pixels) * settings.samples,
                                                 film_push.slot_count, film_push.beam_count);
    if (film_push.uses_map && !film_push.uses_colors && scene.report.has_media)
        media = prepare_media_light(device, scene, map->photons, choose_k(settings.estimate), progress);
    for (std::uint64_t first = 0; first < pixels; first += per_chunk) {
        const std::uint64_t count = std::min(per_chunk, pixels - first);
        // Whatever stage a chunk is in, what is reported is the image's own progress.
        const Progress within{[&](std::string_view, double fraction) {
            progress.report("render", (static_cast<double>(first) + fraction * static_cast<double>(count)) /
                                          static_cast<double>(pixels));
            return true;
        }};
        within.report("render", 0.0);
        eye.first_sample = static_cast<std::uint32_t>(first * settings.samples);
        eye.sample_count = film_push.sample_count = static_cast<std::uint32_t>(count * settings.samples);
        film_push.first_pixel = static_cast<std::uint32_t>(first);
        film_push.pixel_count = static_cast<std::uint32_t>(count);
        render_chunk(scratch, within);
    }
    progress.report("render", 1.0);
    return {settings.width, settings.height, read_vectors(film, pixels), {}};
}

void require_request(const RenderSettings& settings, const RenderedMap* map) {
    require_settings("render", settings);
    if (std::uint64_t{settings.width} * settings.height * settings.samples > UINT32_MAX)
        throw Error("render: width × height × samples exceeds 2^32; render fewer samples, or the image in parts");
    if (!map && settings.mode != RenderMode::direct)
        throw Error("render: this mode needs a photon map; trace one, or use mode=\"direct\"");
    if (settings.mode == RenderMode::false_color && !map->photons.colors)
        throw Error("render: the photons have no colors; run a script that calls setPhotonColourEncoding first");
}

// Whether all that photons may lie on faces one way.
bool expects_one_normal(const Scene& scene) {
    std::optional<glm::vec3> first;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const shared::Material& material =
            scene.materials[std::bit_cast<std::uint32_t>(scene.triangles[i].v1_material.w)];
        if (material.base_color_metallic.w >= 1.0f || material.emission_transmission.w >= 1.0f)
            continue; // nothing diffuse
        for (const glm::vec4& normal : {scene.normals[i].n0, scene.normals[i].n1, scene.normals[i].n2}) {
            if (first && *first != glm::vec3(normal))
                return false;
            first = glm::vec3(normal);
        }
    }
    return true;
}

} // namespace

std::vector<gpu::KernelSource> list_render_kernels(const Scene& scene, Store store, const RenderSettings& settings) {
    if (settings.mode == RenderMode::photons)
        return {name_plot_kernel(scene)};
    if (settings.mode == RenderMode::voronoi)
        return {};
    const Parts parts = choose_parts(settings.mode, store);
    std::vector<gpu::KernelSource> kernels{name_eye_kernel(scene)};
    if (parts.direct)
        kernels.push_back(name_light_kernel(scene));
    if (parts.map)
        for (gpu::KernelSource& kernel : list_estimate_kernels(settings.estimate, expects_one_normal(scene)))
            kernels.push_back(std::move(kernel));
    if (parts.colors)
        kernels.push_back(name_color_kernel());
    if (scene.report.has_media)
        kernels.push_back(name_beam_kernel(scene));
    if (scene.report.has_media && parts.direct)
        kernels.push_back(name_beam_light_kernel(scene));
    kernels.push_back(name_film_kernel(scene));
    return kernels;
}

Image render_image(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const RenderedMap* map,
                   const CameraChoice& looks, const RenderSettings& settings, const Progress& progress) {
    require_request(settings, map);
    const shared::CameraFrame camera =
        frame_camera(scene.origin, find_camera(scene, looks), settings.width, settings.height);
    if (settings.mode == RenderMode::photons)
        return plot_photons(device, scene, buffers, map->photons, camera, settings.width, settings.height, progress);
    Renderer renderer{device, scene, buffers, map, settings};
    const SceneReport& report = scene.report;
    const bool splits =
        report.has_dielectric || report.has_thin || report.has_mixed_receiver || report.has_translucency;
    renderer.eye.camera = camera;
    renderer.eye.width = settings.width;
    renderer.eye.height = settings.height;
    renderer.eye.samples = renderer.film_push.samples = settings.samples;
    renderer.eye.seed = renderer.film_push.seed = settings.seed;
    renderer.eye.max_bounces = settings.max_bounces;
    renderer.eye.slot_count = renderer.film_push.slot_count = splits ? SPLIT_SLOTS : 1;
    renderer.film_push.light_count = static_cast<std::uint32_t>(scene.lights.size());
    for (const shared::Light& light : scene.lights)
        if (find_kind(light) == shared::LIGHT_ENVIRONMENT && !has_image(light))
            renderer.eye.environment += light.intensity;
    renderer.eye.environment.w = std::bit_cast<float>(renderer.film_push.light_count);
    if (report.has_media) {
        const shared::Media media = find_media(scene, glm::dvec3(camera.position));
        renderer.film_push.beam_count = BEAMS_PER_SAMPLE;
        renderer.eye.media = {media.inner, media.around, BEAMS_PER_SAMPLE, 0};
    }
    const Parts parts = choose_parts(settings.mode, map ? map->store : Store::caustic);
    renderer.film_push.uses_emission = parts.emission;
    renderer.film_push.uses_map = parts.map;
    renderer.film_push.uses_colors = parts.colors;
    renderer.film_push.uses_direct = parts.direct;
    return renderer.run(progress);
}

} // namespace photonloupe
