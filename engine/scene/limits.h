// SPDX-License-Identifier: Apache-2.0
// How large a scene may be before it is refused: each limit is checked before the memory it guards is asked for.
#pragma once

#include <cstddef>
#include <cstdint>

namespace photonloupe {

// The text is held as a tree of about 20 times its size while it is checked: 64 MiB stay near 1 GiB.
constexpr std::uint64_t MAX_JSON_BYTES = 64ull << 20;
// Deeper nesting occurs in no glTF feature; it only costs the parsers behind us their stacks.
constexpr std::size_t MAX_JSON_DEPTH = 64;
// tinygltf keeps byte lengths in 32-bit integers; this holds for one buffer and for all of them together.
constexpr std::uint64_t MAX_BUFFER_BYTES = (1ull << 31) - 1;
// Sparse and compressed data is decoded beside the buffers: as much again.
constexpr std::uint64_t MAX_DECODED_BYTES = MAX_BUFFER_BYTES;
// A GLB holds its JSON and one buffer.
constexpr std::uint64_t MAX_FILE_BYTES = MAX_JSON_BYTES + MAX_BUFFER_BYTES;
// Nodes, meshes, accessors, materials …: each entry costs a few hundred bytes, a million primitives are no scene.
constexpr std::size_t MAX_ENTRIES = 1u << 18;
// Each image is a file to open; a scene that lists more than this is not one for us.
constexpr std::size_t MAX_IMAGES = 4096;
// Of one image's file, as it is stored.
constexpr std::uint64_t MAX_IMAGE_BYTES = 256ull << 20;
// Keys of one animated part are copied: 2^22 numbers are 32 MiB.
constexpr std::uint64_t MAX_ANIMATION_NUMBERS = 1u << 22;
// Of one primitive: each target is looked at for each vertex.
constexpr std::size_t MAX_MORPH_TARGETS = 1024;
// Beyond, a float tells no texels apart; times the largest factor of a transform, 10^6, it stays a number.
constexpr double MAX_TEXTURE_COORDINATE = 1e6;
// Of all textures together, decoded, 4 bytes each: larger ones are halved until they fit.
constexpr std::uint64_t MAX_TEXELS = 1ull << 27;
// Of all images together as they are decoded: small files can hold large ones.
constexpr std::uint64_t MAX_DECODED_TEXELS = 1ull << 31;
// Transforms are composed along this many parents; exporters stay below 100.
constexpr std::size_t MAX_NODE_DEPTH = 256;
// Triangles are 48 bytes, and graphics drivers allow 2 GiB in one allocation: 2^25 · 48 bytes are 1.5 GiB.
constexpr std::uint64_t MAX_TRIANGLES = 1u << 25;
// Primitives that nodes and instances draw: each costs about a kilobyte while a scene is loaded.
constexpr std::uint64_t MAX_OBJECTS = 1u << 20;
// Beyond this the square of a length, and soon the length itself, leaves the range of 32-bit floats.
constexpr double MAX_COORDINATE = 1e30;

} // namespace photonloupe
