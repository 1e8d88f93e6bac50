// SPDX-License-Identifier: Apache-2.0
// Checks the extension's parameters, which the library asserts, and calls it.
#include "scene/gltf_meshopt.h"

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";
constexpr std::uint64_t MAX_STRIDE = 256;

struct Parameters {
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
    std::string mode;
    std::string filter;
};

bool is_allowed(const Parameters& parameters) {
    const std::uint64_t stride = parameters.stride;
    const std::string& filter = parameters.filter;
    if (parameters.mode == "ATTRIBUTES")
        return stride % 4 == 0 &&
               (filter == "NONE" || filter == "EXPONENTIAL" ||
                (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) || (filter == "QUATERNION" && stride == 8));
    const bool is_triangles = parameters.mode == "TRIANGLES" && parameters.count % 3 == 0;
    return (is_triangles || parameters.mode == "INDICES") && filter == "NONE" && (stride == 2 || stride == 4);
}

Parameters read_parameters(const JsonPlace& extension) {
    Parameters parameters;
    parameters.count = read_unsigned(require_member(extension, "count"), MAX_BUFFER_BYTES);
    parameters.stride = read_unsigned(require_member(extension, "byteStride"), MAX_STRIDE);
    parameters.mode = read_string(require_member(extension, "mode"));
    parameters.filter = read_string_or(find_member(extension, "filter"), "NONE");
    if (parameters.count == 0 || parameters.stride == 0 || !is_allowed(parameters))
        refuse(extension,
               std::to_string(parameters.count) + " elements of " + std::to_string(parameters.stride) +
                   " bytes, mode " + quote_text(parameters.mode) + ", filter " + quote_text(parameters.filter) +
                   " are nothing that EXT_meshopt_compression has",
               REMEDY);
    return parameters;
}

} // namespace

std::uint64_t measure_meshopt(const JsonPlace& extension) {
    const Parameters parameters = read_parameters(extension);
    return parameters.count * parameters.stride;
}

void decode_meshopt(const JsonPlace& extension, std::span<const unsigned char> source,
                    std::span<unsigned char> target) {
    const Parameters parameters = read_parameters(extension);
    int error = 0;
    if (parameters.mode == "ATTRIBUTES")
        error = meshopt_decodeVertexBuffer(target.data(), parameters.count, parameters.stride, source.data(),
                                           source.size());
    else if (parameters.mode == "TRIANGLES")
        error =
            meshopt_decodeIndexBuffer(target.data(), parameters.count, parameters.stride, source.data(), source.size());
    else
        error = meshopt_decodeIndexSequence(target.data(), parameters.count, parameters.stride, source.data(),
                                            source.size());
    if (error != 0)
        refuse(extension, "its data can't be decompressed", REMEDY);
    if (parameters.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(target.data(), parameters.count, parameters.stride);
    else if (parameters.filter == "QUATERNION")
        meshopt_decodeFilterQuat(target.data(), parameters.count, parameters.stride);
    else if (parameters.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(target.data(), parameters.count, parameters.stride);
}

} // namespace photonloupe
