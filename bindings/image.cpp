// SPDX-License-Identifier: Apache-2.0
// Binds engine/image: EXR and PNG files with their provenance.
#include "binding.h"

#include "core/atomic_file.h"
#include "image/exr.h"
#include "image/png.h"

namespace photonloupe::bindings {

using Attributes = std::map<std::string, std::string>;

void bind_image(nb::module_& module) {
    module.def(
        "write_file",
        [](const std::string& path, nb::bytes content) {
            write_file_atomically(path, {reinterpret_cast<const unsigned char*>(content.c_str()), content.size()});
        },
        "path"_a, "content"_a, "Write a file so that a killed program leaves the old one or the new one.");
    module.def(
        "write_exr",
        [](const std::string& path, const Pixels& pixels, Attributes attributes) {
            write_exr(path, take_image(pixels, std::move(attributes)));
        },
        "path"_a, "pixels"_a, "attributes"_a);
    module.def(
        "read_exr",
        [](const std::string& path) {
            Image image = read_exr(path);
            return nb::make_tuple(own_pixels(std::move(image.rgb), image.height, image.width), image.attributes);
        },
        "path"_a);
    module.def(
        "write_png",
        [](const std::string& path, const Pixels& pixels, double exposure, Attributes attributes) {
            write_png(path, take_image(pixels, std::move(attributes)), exposure);
        },
        "path"_a, "pixels"_a, "exposure"_a, "attributes"_a);
    module.def(
        "encode_png",
        [](const Pixels& pixels, double exposure, Attributes attributes) {
            const std::vector<unsigned char> bytes = encode_png(take_image(pixels, std::move(attributes)), exposure);
            return nb::bytes(bytes.data(), bytes.size());
        },
        "pixels"_a, "exposure"_a, "attributes"_a);
    module.def(
        "read_png",
        [](const std::string& path) {
            PngImage image = read_png(path);
            return nb::make_tuple(own_pixels(std::move(image.rgb), image.height, image.width), image.attributes);
        },
        "path"_a);
}

} // namespace photonloupe::bindings
