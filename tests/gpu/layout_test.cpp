// SPDX-License-Identifier: Apache-2.0
// Every kernel compiles in every variant, and its structs lie in memory as the C++ ones do.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "gpu/compile_glsl.h"
#include "gpu/host_layout.h"
#include "gpu/kernel_source.h"
#include "gpu/kernel_variants.h"
#include "gpu/reflect_spirv.h"
#include "shared/inspect.h"
#include "shared/parallel.h"
#include "shared/photons.h"
#include "shared/relax.h"
#include "shared/render.h"
#include "shared/scene.h"
#include "shared/splat.h"
#include "shared/trace.h"

namespace photonloupe::test {
namespace {

#define STRUCT(type) {#type, measure_host_struct<shared::type>()}

const std::map<std::string, HostStruct> HOST_STRUCTS{
    STRUCT(Triangle),        STRUCT(TriangleNormals),  STRUCT(Material),          STRUCT(Light),
    STRUCT(BvhNode),         STRUCT(SceneHeader),      STRUCT(TraceSettings),     STRUCT(LightEmission),
    STRUCT(PathSummary),     STRUCT(BalanceSum),       STRUCT(TreeNode),          STRUCT(TreeBuild),
    STRUCT(ReachSettings),   STRUCT(ListSettings),     STRUCT(SortSettings),      STRUCT(CameraFrame),
    STRUCT(EyeSettings),     STRUCT(FilmSettings),     STRUCT(PlotSettings),      STRUCT(TreeRefit),
    STRUCT(GatherSettings),  STRUCT(RepelSettings),    STRUCT(DescribeSettings),  STRUCT(MoveSettings),
    STRUCT(CrossingJob),     STRUCT(CrossingSettings), STRUCT(CoverageSettings),  STRUCT(BlendSettings),
    STRUCT(PixelSettings),   STRUCT(SurfaceSettings),  STRUCT(CellSettings),      STRUCT(SplatSettings),
    STRUCT(ResolveSettings), STRUCT(TreeBracket),      STRUCT(EmittingTriangle),  STRUCT(EnvironmentHeader),
    STRUCT(Texture),         STRUCT(MaterialPaint),    STRUCT(CornerCoordinates), STRUCT(CornerColors),
    STRUCT(BeamSettings),
};

std::vector<std::uint32_t> compile(const KernelVariant& variant, std::uint64_t by_address = 0) {
    return gpu::compile_glsl(
        gpu::declare_bindings(gpu::expand_source({.path = variant.path}), variant.defines, by_address), variant.path);
}

std::string describe(const KernelVariant& variant) {
    std::string text = variant.path;
    for (const std::string& define : variant.defines)
        text += ", " + define;
    return text;
}

// All kernels as they are built, and the probe with the structs that kernels read as texels.
std::map<std::string, Reflection> reflect_kernels() {
    std::map<std::string, Reflection> reflections;
    for (const KernelVariant& variant : list_variants())
        if (!reflections.contains(variant.path) || variant.defines.size() > 3)
            reflections[variant.path] = reflect_spirv(compile(variant));
    reflections["probe_layouts.comp"] = reflect_spirv(compile({"probe_layouts.comp", {}}));
    return reflections;
}

void expect_same_layout(const ReflectedStruct& found, const HostStruct& host) {
    ASSERT_EQ(found.members.size(), host.members.size());
    for (std::size_t i = 0; i < host.members.size(); ++i) {
        EXPECT_EQ(found.members[i].offset, host.members[i].offset) << found.members[i].name;
        EXPECT_EQ(found.members[i].size_bytes, host.members[i].size_bytes) << found.members[i].name;
    }
    if (found.array_stride != 0) {
        EXPECT_EQ(found.array_stride, host.size_bytes) << "array stride";
    }
}

TEST(Layout, every_kernel_compiles_in_every_variant) {
    for (const KernelVariant& variant : list_variants())
        EXPECT_NO_THROW(compile(variant)) << describe(variant);
}

TEST(Layout, every_kernel_compiles_with_all_buffers_by_address) {
    for (const KernelVariant& variant : list_variants()) {
        const std::size_t bindings = gpu::expand_source({.path = variant.path}).bindings.size();
        EXPECT_NO_THROW(compile(variant, (1ull << bindings) - 1)) << describe(variant);
    }
}

TEST(Layout, shared_structs_have_the_members_offsets_and_strides_of_the_host) {
    for (const auto& [path, reflection] : reflect_kernels())
        for (const auto& [name, found] : reflection.structs) {
            SCOPED_TRACE(path + ", struct " + name);
            const auto host = HOST_STRUCTS.find(name);
            ASSERT_NE(host, HOST_STRUCTS.end()) << "a struct that this test's table does not know";
            expect_same_layout(found, host->second);
        }
}

TEST(Layout, every_shared_struct_is_met_in_a_kernel) {
    std::set<std::string> met;
    for (const auto& [path, reflection] : reflect_kernels())
        for (const auto& [name, found] : reflection.structs)
            met.insert(name);
    for (const auto& [name, host] : HOST_STRUCTS)
        EXPECT_TRUE(met.contains(name)) << name;
}

TEST(Layout, loose_push_constants_follow_each_other_without_gaps) {
    for (const auto& [path, reflection] : reflect_kernels()) {
        std::uint32_t expected = 0;
        for (const ReflectedMember& member : reflection.push_constants) {
            EXPECT_EQ(member.offset, expected) << path << ' ' << member.name;
            expected += member.size_bytes;
        }
    }
}

TEST(Layout, push_constants_fit_what_vulkan_guarantees) {
    for (const auto& [path, reflection] : reflect_kernels())
        EXPECT_LE(reflection.push_bytes, 128u) << path;
}

// Texel buffers hold vec4s only.
TEST(Layout, structs_read_as_texels_are_rows_of_vec4) {
    for (const char* name : {"Triangle", "TriangleNormals", "BvhNode", "SceneHeader", "EnvironmentHeader", "TreeNode"})
        EXPECT_EQ(HOST_STRUCTS.at(name).size_bytes % 16, 0u) << name;
}

} // namespace
} // namespace photonloupe::test
