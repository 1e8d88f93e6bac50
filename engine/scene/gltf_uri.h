// SPDX-License-Identifier: Apache-2.0
// Decides what a URI in a scene file may name: embedded data, or a file below the scene's folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// Bytes of a base64 data URI; nothing if the URI is not `data:` at all. Refuses other encodings.
std::optional<std::vector<unsigned char>> decode_data_uri(std::string_view uri, const JsonPlace& place);

// The same of an image, whatever media type it claims: its bytes tell. `uri` begins with `data:`.
std::vector<unsigned char> decode_image_uri(std::string_view uri, const JsonPlace& place);

// The file a relative URI names, with symbolic links resolved, below `folder`. Decodes percent escapes exactly once.
// Refuses absolute paths, schemes, backslashes, NUL and everything that leaves the folder; the file may be missing.
std::filesystem::path resolve_uri(std::string_view uri, const std::filesystem::path& folder, const JsonPlace& place);

} // namespace photonloupe
