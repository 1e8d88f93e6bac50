// SPDX-License-Identifier: Apache-2.0
// Dispatches, copies and chunks: everything is done once, in order, and mistakes are named.
#include "gpu/commands.h"

#include <numeric>
#include <set>

#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/temporary_folder.h"
#include "gpu/compile_glsl.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

using Pieces = std::vector<std::pair<std::uint64_t, std::uint64_t>>; // first, count

const std::vector<glm::vec4> VECTORS(1000, glm::vec4(0.5f, 3.0f, 0, 0));

std::string find_mistake(std::initializer_list<gpu::Binding> bindings, std::uint64_t invocations) {
    try {
        gpu::Commands commands(get_device(), "mistake");
        commands.dispatch({"probe_exact.comp", 64, {"TERMS 1"}, {}}, bindings, 1u, invocations);
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "";
}

TEST(Commands, missing_buffer_is_a_mistake_that_is_named) {
    const gpu::Buffer buffer = gpu::make_buffer(get_device(), VECTORS, "vectors");
    EXPECT_EQ(find_mistake({{"inputs", buffer}}, 1), "kernel probe_exact.comp needs a buffer 'outputs'");
}

TEST(Commands, empty_buffer_is_a_mistake_that_is_named) {
    const gpu::Buffer buffer = gpu::make_buffer(get_device(), VECTORS, "vectors"), empty;
    EXPECT_EQ(find_mistake({{"inputs", empty}, {"outputs", buffer}}, 1),
              "kernel probe_exact.comp needs a buffer 'inputs'");
}

TEST(Commands, dispatch_beyond_the_group_limit_is_a_mistake) {
    const gpu::Buffer buffer = gpu::make_buffer(get_device(), VECTORS, "vectors");
    const std::uint64_t too_many = 64ull * get_device().limits().max_group_count + 1;
    EXPECT_NE(find_mistake({{"inputs", buffer}, {"outputs", buffer}}, too_many).find("cut it in chunks"),
              std::string::npos);
}

TEST(Commands, unknown_kernel_is_named) {
    try {
        run_probe<glm::vec4>(get_device(), "nowhere.comp", VECTORS);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'nowhere.comp' is missing"), std::string::npos) << error.what();
    }
}

TEST(Commands, batch_that_was_never_run_leaves_the_device_usable) {
    {
        const gpu::Commands commands(get_device(), "abandoned");
    }
    EXPECT_EQ(run_probe<glm::vec4>(get_device(), "probe_exact.comp", VECTORS, {"TERMS 1"})[999].w, 3.5f);
}

TEST(Commands, steps_see_what_the_one_before_wrote) {
    const gpu::Buffer first(get_device(), 4096, "first"), second(get_device(), 4096, "second");
    gpu::Commands commands(get_device(), "steps");
    commands.fill(first, 7);
    commands.copy(first, 0, second, 0, 4096);
    commands.fill(first, 9);
    commands.copy(first, 0, second, 2048, 1024);
    commands.run();
    const std::vector<std::uint32_t> numbers = second.read<std::uint32_t>(1024);
    EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0u), 768u * 7 + 256u * 9);
}

TEST(Commands, more_dispatches_than_a_descriptor_pool_holds_all_run) {
    const gpu::Buffer input = gpu::make_buffer(get_device(), VECTORS, "inputs");
    std::vector<gpu::Buffer> outputs;
    gpu::Commands commands(get_device(), "many");
    for (int i = 0; i < 100; ++i) {
        outputs.emplace_back(get_device(), 16, "outputs");
        commands.dispatch({"probe_exact.comp", 64, {"TERMS 1"}, {}}, {{"inputs", input}, {"outputs", outputs.back()}},
                          1u, 1);
    }
    commands.run();
    for (const gpu::Buffer& output : outputs)
        EXPECT_EQ(output.read<glm::vec4>(1)[0].w, 3.5f);
}

TEST(Commands, buffers_by_address_give_the_same_bits) {
    const ScopedVariable range("PHOTONLOUPE_STORAGE_RANGE", "64");
    gpu::Device device;
    const std::vector<std::string> defines{"TERMS 3"};
    EXPECT_EQ(run_probe<glm::vec4>(device, "probe_exact.comp", VECTORS, defines),
              run_probe<glm::vec4>(get_device(), "probe_exact.comp", VECTORS, defines));
}

Pieces cut(std::uint64_t total, std::uint64_t granule, const Progress& progress = {}) {
    Pieces pieces;
    gpu::run_in_chunks(
        get_device(), "cut", total, granule, progress,
        [&](gpu::Commands&, std::uint64_t first, std::uint64_t count) { pieces.emplace_back(first, count); });
    return pieces;
}

TEST(Chunks, cover_everything_once_in_order) {
    for (std::uint64_t total : {1ull, 63ull, 64ull, 65ull, 100'000ull, 1ull << 33}) {
        std::uint64_t next = 0;
        for (const auto& [first, count] : cut(total, 64)) {
            EXPECT_EQ(first, next);
            next += count;
        }
        EXPECT_EQ(next, total);
    }
}

TEST(Chunks, are_whole_granules_but_for_the_last) {
    const Pieces pieces = cut(100'000, 64);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
        EXPECT_EQ(pieces[i].second % 64, 0u);
}

TEST(Chunks, grow_while_they_are_fast) {
    EXPECT_LT(cut(1 << 20, 1).size(), 100u);
}

TEST(Chunks, of_nothing_run_nothing) {
    EXPECT_TRUE(cut(0, 64).empty());
}

TEST(Chunks, report_fractions_that_rise_from_zero_to_one) {
    std::vector<double> fractions;
    cut(100'000, 64, {[&](std::string_view, double fraction) {
            fractions.push_back(fraction);
            return true;
        }});
    EXPECT_EQ(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST(Chunks, stop_on_request_naming_the_stage) {
    try {
        cut(1000, 1, {[](std::string_view, double fraction) { return fraction < 0.001; }});
        FAIL();
    } catch (const Cancelled& stopped) {
        EXPECT_STREQ(stopped.what(), "cut: stopped on request");
    }
}

TEST(Chunks, do_no_work_after_they_are_stopped) {
    int runs = 0;
    const Progress stop_at_second{[&](std::string_view, double fraction) { return fraction == 0.0; }};
    EXPECT_THROW(gpu::run_in_chunks(get_device(), "cut", 1000, 1, stop_at_second,
                                    [&](gpu::Commands&, std::uint64_t, std::uint64_t) { ++runs; }),
                 Cancelled);
    EXPECT_EQ(runs, 1);
}

class SpirvCache : public ::testing::Test {
protected:
    TemporaryFolder m_folder;
    ScopedVariable m_place{"PHOTONLOUPE_CACHE_DIR", m_folder.get_path().string()};
    const std::string m_text = "#version 460\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
    const std::vector<std::uint32_t> m_words = gpu::compile_glsl(m_text, "empty");

    std::string find_file() const {
        for (const auto& entry : std::filesystem::directory_iterator(m_folder.get_path() / "spirv"))
            return "spirv/" + entry.path().filename().string();
        return "";
    }
};

TEST_F(SpirvCache, damaged_file_is_compiled_again_and_replaced) {
    const std::string name = find_file(), whole = m_folder.read(name);
    std::string flipped = whole, longer = whole + "tail";
    flipped[40] ^= 1;
    for (const std::string& damaged : {std::string(), std::string("x"), whole.substr(0, whole.size() / 2), flipped,
                                       longer, std::string(whole.size(), '\0')}) {
        m_folder.write(name, damaged);
        EXPECT_EQ(gpu::compile_glsl(m_text, "empty"), m_words) << damaged.size();
        EXPECT_EQ(m_folder.read(name), whole) << damaged.size();
    }
}

TEST_F(SpirvCache, whole_file_is_used) {
    // Another text's words under this text's name: only a cache that is read hands them out.
    const std::string name = find_file();
    const auto other = gpu::compile_glsl("#version 460\nlayout(local_size_x = 2) in;\nvoid main() {}\n", "other");
    for (const auto& entry : std::filesystem::directory_iterator(m_folder.get_path() / "spirv"))
        if ("spirv/" + entry.path().filename().string() != name)
            m_folder.write(name, m_folder.read("spirv/" + entry.path().filename().string()));
    EXPECT_EQ(gpu::compile_glsl(m_text, "empty"), other);
}

} // namespace
} // namespace photonloupe::test
