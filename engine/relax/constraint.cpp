// SPDX-License-Identifier: Apache-2.0
// Drives the descriptor kernels.
#include "relax/constraint.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "measure constraint";
constexpr std::uint32_t SAVED_LIST_WORDS = 10 + 1024; // shaders/relax/measure_split.comp

} // namespace

Constraint measure_constraint(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                              const ConstraintSettings& settings, const gpu::Buffer& radii, const Progress& progress) {
    const std::uint64_t bytes = queries.count * sizeof(glm::vec4);
    Constraint constraint{gpu::Buffer(device, bytes, "constraint basis"),
                          gpu::Buffer(device, bytes, "constraint basis"), gpu::Buffer(device, bytes, "gradients"),
                          gpu::Buffer(device, bytes, "constraint radii")};
    const std::uint32_t rank = rank_for(settings.neighbors);
    find_radii(device, neighborhood, queries, {rank}, radii, STAGE, progress);
    const shared::DescribeSettings push{make_gather_settings(neighborhood, rank), settings.free_at, settings.fixed_at,
                                        0, 0};
    GatherKernel kernel{"relax/measure_moments.comp",
                        {"DESCRIPTOR " + std::to_string(static_cast<std::uint32_t>(settings.descriptor))},
                        {{"radii", radii},
                         {"offsets", constraint.offsets},
                         {"member_radii", constraint.member_radii},
                         {"constraint_along", constraint.along},
                         {"constraint_across", constraint.across}}};
    gather(device, neighborhood, queries, kernel, push, STAGE, progress);
    kernel.defines.clear();
    if (settings.descriptor == Descriptor::tensor) {
        kernel.path = "relax/measure_tensor.comp";
        gather(device, neighborhood, queries, kernel, push, STAGE, progress);
    }
    if (settings.descriptor == Descriptor::split) {
        kernel.path = "relax/measure_split.comp";
        kernel.takes_subgroups = true;
        kernel.saved_words = SAVED_LIST_WORDS;
        gather(device, neighborhood, queries, kernel, push, STAGE, progress);
    }
    return constraint;
}

} // namespace photonloupe
