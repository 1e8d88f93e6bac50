// SPDX-License-Identifier: Apache-2.0
// The exceptions the engine throws: each message says what, where and what to do.
#pragma once

#include <stdexcept>

namespace photonloupe {

// Base of every error a user can cause or meet: bad input, or a machine that cannot do what was asked.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A value that cannot be used.
class ArgumentError : public Error {
public:
    using Error::Error;
};

// The scene file is missing, malformed, hostile, or cannot be lit.
class SceneError : public Error {
public:
    using Error::Error;
};

// No usable Vulkan device, a lost device, a missed deadline, or a validation message.
class DeviceError : public Error {
public:
    using Error::Error;
};

// More memory was asked for than the device or the machine has; the message says what would fit.
class MemoryError : public Error {
public:
    using Error::Error;
};

// The user stopped the work between two chunks (Ctrl-C or a progress callback that returned false).
class Cancelled : public Error {
public:
    using Error::Error;
};

} // namespace photonloupe
