// SPDX-License-Identifier: Apache-2.0
// Liveness: walks a script's blocks backwards until nothing changes.
#include "script/plan/flow.h"

#include <algorithm>
#include <deque>
#include <iterator>

namespace photonloupe::script {
namespace {

void step_back(NameSet& live, const FlowAccess& access) {
    live[access.name] = access.kind == FlowAccess::Kind::read;
}

NameSet join_next(const Flow& flow, const std::vector<NameSet>& at_start, std::uint32_t first, std::uint32_t block) {
    NameSet live(flow.names.count());
    for (std::uint32_t next : flow.blocks[block].next)
        if (next >= first && next - first < at_start.size())
            for (std::uint32_t name = 0; name < live.size(); ++name)
                if (at_start[next - first][name])
                    live[name] = true;
    return live;
}

} // namespace

std::vector<NameSet> find_live_names(const Flow& flow, std::uint32_t first, std::uint32_t end) {
    std::vector<NameSet> at_start(end - first, NameSet(flow.names.count()));
    std::vector<std::vector<std::uint32_t>> before(end - first);
    std::deque<std::uint32_t> waiting;
    std::vector<bool> is_waiting(end - first, true);
    for (std::uint32_t block = end; block-- > first;) {
        waiting.push_back(block);
        for (std::uint32_t next : flow.blocks[block].next)
            if (next >= first && next < end)
                before[next - first].push_back(block);
    }
    while (!waiting.empty()) {
        const std::uint32_t block = waiting.front();
        waiting.pop_front();
        is_waiting[block - first] = false;
        NameSet live = join_next(flow, at_start, first, block);
        const std::vector<FlowAccess>& accesses = flow.blocks[block].accesses;
        for (auto access = accesses.rbegin(); access != accesses.rend(); ++access)
            step_back(live, *access);
        if (live == at_start[block - first])
            continue;
        at_start[block - first] = std::move(live);
        for (std::uint32_t earlier : before[block - first])
            if (!is_waiting[earlier - first]) {
                is_waiting[earlier - first] = true;
                waiting.push_back(earlier);
            }
    }
    return at_start;
}

NameSet find_unset_reads(const Flow& flow, const std::vector<NameSet>& live) {
    NameSet unset = live[0];
    std::fill_n(unset.begin(), std::size(PREDEFINED_VALUES), false);
    for (std::uint32_t block = 0; block < flow.blocks.size(); ++block) {
        NameSet here = join_next(flow, live, 0, block);
        const std::vector<FlowAccess>& accesses = flow.blocks[block].accesses;
        for (auto access = accesses.rbegin(); access != accesses.rend(); ++access) {
            if (access->kind == FlowAccess::Kind::forget && here[access->name])
                unset[access->name] = true;
            step_back(here, *access);
        }
    }
    return unset;
}

} // namespace photonloupe::script
