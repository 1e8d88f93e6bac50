// SPDX-License-Identifier: Apache-2.0
// Drives the descriptor kernels.
#include "relax/constraint.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "measure constraint";
constexpr std::uint32_t SAVED_LIST_WORDS = 10 + 1024; // shaders/relax/measure_split.comp

// What a descriptor is measured by, in this order.
std::vector<GatherKernel> name_measures(Descriptor descriptor) {
    std::vector<GatherKernel> kernels{
        {"relax/measure_moments.comp", {"DESCRIPTOR " + std::to_string(static_cast<std::uint32_t>(descriptor))}, {}}};
    if (descriptor == Descriptor::tensor)
        kernels.push_back({"relax/measure_tensor.comp", {}, {}});
    if (descriptor == Descriptor::split)
        kernels.push_back({"relax/measure_split.comp", {}, {}, true, SAVED_LIST_WORDS});
    return kernels;
}

std::vector<gpu::KernelSource> list_kernels(const Neighborhood& neighborhood, const Queries& queries,
                                            const RelaxSettings& settings) {
    std::vector<gpu::KernelSource> kernels{
        name_radius_kernel(neighborhood, queries, {rank_for(*settings.constraint_neighbors)})};
    for (const GatherKernel& kernel : name_measures(settings.descriptor))
        kernels.push_back(name_gather_kernel(neighborhood, queries, kernel));
    return kernels;
}

} // namespace

Constraint measure_constraint(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                              const RelaxSettings& settings, const gpu::Buffer& radii, const Progress& progress) {
    const std::uint64_t bytes = queries.count * sizeof(glm::vec4);
    Constraint constraint{gpu::Buffer(device, bytes, "constraint basis"),
                          gpu::Buffer(device, bytes, "constraint basis"), gpu::Buffer(device, bytes, "gradients"),
                          gpu::Buffer(device, bytes, "constraint radii")};
    const std::uint32_t rank = rank_for(*settings.constraint_neighbors);
    device.compile_ahead(list_kernels(neighborhood, queries, settings));
    find_radii(device, neighborhood, queries, {rank}, radii, STAGE, progress);
    const shared::DescribeSettings push{make_gather_settings(neighborhood, rank),
                                        static_cast<float>((*settings.thresholds)[0]),
                                        static_cast<float>((*settings.thresholds)[1]), 0, 0};
    for (GatherKernel& kernel : name_measures(settings.descriptor)) {
        for (const gpu::Binding& binding : {gpu::Binding{"radii", radii},
                                            {"offsets", constraint.offsets},
                                            {"member_radii", constraint.member_radii},
                                            {"constraint_along", constraint.along},
                                            {"constraint_across", constraint.across}})
            kernel.bindings.push_back(binding);
        gather(device, neighborhood, queries, kernel, push, STAGE, progress);
    }
    return constraint;
}

} // namespace photonloupe
