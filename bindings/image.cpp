// SPDX-License-Identifier: Apache-2.0
// Binds engine/image: EXR and PNG files with their provenance.
#include "binding.h"

#include "core/atomic_file.h"

#include "image/exr.h"
#include "image/png.h"

namespace photonloupe::bindings {
namespace {

using Pixels = nb::ndarray<nb::numpy, const float, nb::shape<-1, -1, 3>, nb::c_contig>;
using Attributes = std::map<std::string, std::string>;

Image take_image(const Pixels& pixels, Attributes attributes) {
    return {static_cast<std::uint32_t>(pixels.shape(1)), static_cast<std::uint32_t>(pixels.shape(0)),
            std::vector<float>(pixels.data(), pixels.data() + pixels.size()), std::move(attributes)};
}

} // namespace

void bind_image(nb::module_& module) {
    module.def(
        "write_file",
        [](const std::string& path, nb::bytes content) {
            write_file_atomically(path, {reinterpret_cast<const unsigned char*>(content.c_str()), content.size()});
        },
        nb::arg("path"), nb::arg("content"),
        "Write a file so that a killed program leaves the old one or the new one.");
    module.def(
        "write_exr",
        [](const std::string& path, const Pixels& pixels, Attributes attributes) {
            write_exr(path, take_image(pixels, std::move(attributes)));
        },
        nb::arg("path"), nb::arg("pixels"), nb::arg("attributes"));
    module.def(
        "read_exr",
        [](const std::string& path) {
            Image image = read_exr(path);
            return nb::make_tuple(own_pixels(std::move(image.rgb), image.height, image.width), image.attributes);
        },
        nb::arg("path"));
    module.def(
        "write_png",
        [](const std::string& path, const Pixels& pixels, double exposure, Attributes attributes) {
            write_png(path, take_image(pixels, std::move(attributes)), exposure);
        },
        nb::arg("path"), nb::arg("pixels"), nb::arg("exposure"), nb::arg("attributes"));
    module.def(
        "encode_png",
        [](const Pixels& pixels, double exposure, Attributes attributes) {
            const std::vector<unsigned char> bytes = encode_png(take_image(pixels, std::move(attributes)), exposure);
            return nb::bytes(bytes.data(), bytes.size());
        },
        nb::arg("pixels"), nb::arg("exposure"), nb::arg("attributes"));
    module.def(
        "read_png",
        [](const std::string& path) {
            PngImage image = read_png(path);
            return nb::make_tuple(own_pixels(std::move(image.rgb), image.height, image.width), image.attributes);
        },
        nb::arg("path"));
}

} // namespace photonloupe::bindings
