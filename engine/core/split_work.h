// SPDX-License-Identifier: Apache-2.0
// Spreads a loop over the processor's cores; every item is computed as it would be by one of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace photonloupe {

// Runs `work(first, end)` over [0, count) in runs of at least `least` items, and waits; throws what one of them threw.
template <class Work>
void split_work(std::size_t count, std::size_t least, const Work& work) {
    const std::size_t cores = std::max(std::thread::hardware_concurrency(), 1u);
    const std::size_t parts = std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores);
    std::vector<std::future<void>> running;
    for (std::size_t part = 1; part < parts; ++part)
        running.push_back(std::async(std::launch::async, work, count * part / parts, count * (part + 1) / parts));
    work(std::size_t{0}, count / parts);
    for (std::future<void>& part : running)
        part.get();
}

} // namespace photonloupe
