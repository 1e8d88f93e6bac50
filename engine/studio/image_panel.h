// SPDX-License-Identifier: Apache-2.0
// The rendered picture: exposure, tone, false colors laid over it, and how it differs from a reference.
#pragma once

#include "studio/workspace.h"

namespace photonloupe::studio {

class ImagePanel {
public:
    void draw(Workspace& workspace);

private:
    void draw_choices(Workspace& workspace);
    void draw_numbers(const Workspace& workspace);
    void draw_image(Workspace& workspace);

    std::string m_key;
    std::string m_reference; // in the field
    std::uint32_t m_width = 0, m_height = 0;
};

} // namespace photonloupe::studio
