// SPDX-License-Identifier: Apache-2.0
// Opens the tests' device, and lets kernels be found in the source tree and beside the tests.
#include "support/shared_device.h"

#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "gpu/compile_ahead.h"

namespace photonloupe::test {
namespace {

class ShaderFolders : public ::testing::Environment {
public:
    void SetUp() override {
        const char* given = std::getenv("PHOTONLOUPE_SHADER_DIR");
        const std::string folders = given && *given ? given : PHOTONLOUPE_SOURCE_DIR "/shaders";
        setenv("PHOTONLOUPE_SHADER_DIR", (folders + ":" PHOTONLOUPE_SOURCE_DIR "/tests/gpu/shaders").c_str(), 1);
        // A child that spoils its device must start afresh, not from a copy of our threads.
        GTEST_FLAG_SET(death_test_style, "threadsafe");
    }
    void TearDown() override { gpu::CompileAhead::stop_all(); } // the device goes with the globals
};

[[maybe_unused]] ::testing::Environment* const FOLDERS = ::testing::AddGlobalTestEnvironment(new ShaderFolders);

} // namespace

gpu::Device& get_device() {
    static gpu::Device device;
    return device;
}

ScopedVariable::ScopedVariable(const char* name, const std::string& value) : m_name(name) {
    if (const char* old = std::getenv(name))
        m_old = old;
    setenv(name, value.c_str(), 1);
}

ScopedVariable::~ScopedVariable() {
    if (m_old)
        setenv(m_name, m_old->c_str(), 1);
    else
        unsetenv(m_name);
}

} // namespace photonloupe::test
