// SPDX-License-Identifier: Apache-2.0
// Random scripts on the device beside the interpreter: the same bits. PHOTONLOUPE_RANDOM_SCRIPTS sets how many.
#include <cstdlib>

#include <gtest/gtest.h>

#include "script/random_script.h"
#include "script/run_on_device.h"

namespace photonloupe::script::tests {
namespace {

constexpr int USUAL_SCRIPTS = 300; // a nightly run takes 10,000
constexpr std::uint32_t FIRST_SEED = 70'000;
constexpr std::uint32_t PHOTONS = 4'200; // more than a block

int count_scripts() {
    const char* const text = std::getenv("PHOTONLOUPE_RANDOM_SCRIPTS");
    return text ? std::atoi(text) : USUAL_SCRIPTS;
}

TEST(RandomPasses, random_scripts_give_the_same_bits_on_the_device_and_in_the_interpreter) {
    HostPhotons photons = make_photons(PHOTONS);
    for (std::size_t i = 0; i < photons.positions.size(); ++i)
        photons.positions[i] = float(i % 17) - 3; // sums of small whole numbers are exact
    Comparison any;
    any.is_parallel.reset();
    for (int i = 0; i < count_scripts() && !HasFailure(); ++i) {
        const std::string text = write_random_script(FIRST_SEED + std::uint32_t(i));
        SCOPED_TRACE(text);
        expect_same(text, photons, any);
    }
}

} // namespace
} // namespace photonloupe::script::tests
