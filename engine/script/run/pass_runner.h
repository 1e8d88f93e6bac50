// SPDX-License-Identifier: Apache-2.0
// Runs parallel photon loops on the device: brings a pass what it reads, and fetches what it reduced, met and missed.
#pragma once

#include <functional>
#include <span>

#include "gpu/commands.h"
#include "photons/photon_map.h"
#include "script/emit/emit.h"
#include "script/interpret/interpreter.h"
#include "script/run/device_columns.h"
#include "shared/script.h"

namespace photonloupe::script {

// Ids of the k nearest photons of some, a row each, -1 where there are fewer.
using FindRows = std::function<gpu::Buffer(NeighborQuery::Space, std::span<const std::uint32_t> photons,
                                           std::uint32_t k, float beta)>;

// The kernel of a pass.
gpu::KernelSource name_kernel(const EmittedPass& pass);

class PassRunner {
public:
    // All must outlive it; `passes` go with plan.loops.
    PassRunner(gpu::Device& device, const PhotonMap& photons, const Program& program, const Plan& plan,
               const std::vector<EmittedPass>& passes, RunOutputs& outputs, const RunSettings& settings,
               FindRows find_rows, const Progress& progress);

    // False: the device could not, nothing happened, and the interpreter must run the loop.
    bool run(const PhotonLoop& loop, Interpreter& interpreter, LoopReport& report);

private:
    struct Work; // one loop's run

    void fill_uniforms(Work& work) const;
    void ask_neighbors(Work& work, std::uint32_t first_photon, std::uint32_t photon_count) const;
    std::uint32_t choose_batch(const Work& work) const;
    std::uint32_t measure_rounds(Work& work) const;
    void dispatch(gpu::Commands& commands, const Work& work, const shared::ScriptPass& push,
                  std::uint32_t groups) const;
    bool run_rounds(Work& work);
    void start_anew(Work& work) const;
    void restore_columns(Work& work) const;
    void run_blocks(Work& work);
    void run_batch(Work& work, std::uint32_t first_block, std::uint32_t block_count);
    void check_limits(Work& work);
    bool can_hand_over(const Work& work) const;
    std::vector<std::uint32_t> list_late_photons(const Work& work) const;
    bool take_late_photons(Work& work);
    void collect(Work& work);
    void collect_sites(Work& work);
    void collect_histograms(const Work& work);
    void collect_prints(Work& work);

    gpu::Device& m_device;
    const PhotonMap& m_photons;
    const Program& m_program;
    const Plan& m_plan;
    const std::vector<EmittedPass>& m_passes;
    RunOutputs& m_outputs;
    const RunSettings& m_settings;
    FindRows m_find_rows;
    const Progress& m_progress;
    DeviceColumns m_columns;
    gpu::Buffer m_nothing; // bound where a pass has no use for a buffer
};

} // namespace photonloupe::script
