// SPDX-License-Identifier: Apache-2.0
// Answers "load FILE", "build" and "knn K" on standard input with nanoflann's times; compiled by peer_nanoflann.py.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <nanoflann.hpp>
#include <string>
#include <thread>
#include <vector>

#if NANOFLANN_VERSION < 0x140
#error "nanoflann 1.4 or newer is needed: its constructor builds the tree"
#endif

namespace {

constexpr std::size_t LEAF_PHOTONS = 16;
constexpr std::size_t BLOCK_QUERIES = 1024; // a thread takes so many at a time

struct Cloud {
    std::vector<float> values; // x, y, z of each photon
    std::size_t kdtree_get_point_count() const { return values.size() / 3; }
    float kdtree_get_pt(std::size_t photon, std::size_t axis) const { return values[3 * photon + axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Metric = nanoflann::L2_Simple_Adaptor<float, Cloud>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, std::uint32_t>;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void load(Cloud& cloud, const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    cloud.values.resize(static_cast<std::size_t>(file.tellg()) / sizeof(float));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(cloud.values.data()),
              static_cast<std::streamsize>(cloud.values.size() * sizeof(float)));
}

// The k nearest of every photon, itself included, nearest first, ids and distances, on all cores.
void find_all(const Cloud& cloud, const Tree& tree, std::size_t k, std::vector<std::uint32_t>& ids,
              std::vector<float>& distances) {
    const std::size_t count = cloud.kdtree_get_point_count();
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t first; (first = next.fetch_add(BLOCK_QUERIES)) < count;)
            for (std::size_t photon = first; photon < std::min(first + BLOCK_QUERIES, count); ++photon) {
                float* found = &distances[photon * k];
                tree.knnSearch(&cloud.values[3 * photon], k, &ids[photon * k], found);
                for (std::size_t i = 0; i < k; ++i)
                    found[i] = std::sqrt(found[i]);
            }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back(work);
    for (std::thread& thread : threads)
        thread.join();
}

} // namespace

int main() {
    Cloud cloud;
    std::unique_ptr<Tree> tree;
    std::vector<std::uint32_t> ids;
    std::vector<float> distances;
    std::printf("%d.%d.%d\n", NANOFLANN_VERSION >> 8, NANOFLANN_VERSION >> 4 & 15, NANOFLANN_VERSION & 15);
    std::fflush(stdout);
    for (std::string verb, value; std::cin >> verb >> value;) {
        double start = now(), mean = 0.0;
        if (verb == "load") {
            tree.reset();
            load(cloud, value);
        } else if (verb == "build") {
            tree.reset();
            start = now();
            tree = std::make_unique<Tree>(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(LEAF_PHOTONS));
        } else {
            const std::size_t k = std::stoul(value) + 1; // the photon itself comes first
            const std::size_t size = k * cloud.kdtree_get_point_count();
            ids.resize(size);
            distances.resize(size);
            start = now();
            find_all(cloud, *tree, k, ids, distances);
        }
        const double seconds = now() - start;
        if (verb == "knn")
            for (const float distance : distances)
                mean += distance / static_cast<double>(distances.size());
        std::printf("%.9f %.12g\n", seconds, mean);
        std::fflush(stdout);
    }
}
