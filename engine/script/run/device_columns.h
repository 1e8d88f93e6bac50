// SPDX-License-Identifier: Apache-2.0
// The device's copy of a script's columns, as passes read and write them.
#pragma once

#include "gpu/buffer.h"
#include "script/interpret/script_columns.h"

namespace photonloupe::script {

class DeviceColumns {
public:
    // `columns` must outlive it; from now on they fetch from here what passes wrote.
    DeviceColumns(gpu::Device& device, std::uint64_t photon_count, ScriptColumns& columns);

    // Makes the buffers hold what is newest, for a pass to begin.
    void prepare();

    // float [dimension - 3][photon]; what is unset holds UNSET_BITS. Never empty.
    const gpu::Buffer& parameters() const { return m_parameters; }
    // vec4 a photon: rgb, w 1 where it was set.
    const gpu::Buffer& colors() const { return m_colors; }

private:
    void allocate(gpu::Buffer& buffer, std::uint64_t size_bytes, const char* purpose);
    void upload();
    void download(ScriptColumns& columns) const;

    gpu::Device& m_device;
    std::uint64_t m_photon_count;
    ScriptColumns& m_columns;
    std::size_t m_dimensions = 0; // the buffer has room for
    gpu::Buffer m_parameters, m_colors;
};

} // namespace photonloupe::script
