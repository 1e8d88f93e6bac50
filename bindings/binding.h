// SPDX-License-Identifier: Apache-2.0
// What the binding files share: the open device, arrays that own their values, progress that listens to Python.
#pragma once

#include <exception>
#include <memory>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "gpu/device.h"
#include "pipeline.h"

namespace nb = nanobind;

namespace photonloupe::bindings {

using namespace nb::literals;

// A dictionary: make_row("name"_a = value, …). Values are worked out in no order: none may take what another reads.
template <class... Fields>
nb::dict make_row(const Fields&... fields) {
    nb::dict row;
    ((row[fields.name_] = fields.value), ...);
    return row;
}

// A list of what `describe` says of each.
template <class Range, class Describe>
nb::list list_rows(const Range& range, const Describe& describe) {
    nb::list rows;
    for (const auto& each : range)
        rows.append(describe(each));
    return rows;
}

// A device with its workbench: what Python calls `Device`.
struct OpenDevice {
    gpu::Device device;
    Workbench workbench;
    explicit OpenDevice(const std::string& selector) : device(selector), workbench(device) {}
};

template <class T, std::size_t Width>
using Matrix = nb::ndarray<nb::numpy, T, nb::shape<-1, static_cast<nb::ssize_t>(Width)>, nb::c_contig>;

using Pixels = nb::ndarray<nb::numpy, const float, nb::shape<-1, -1, 3>, nb::c_contig>;

// Owns a value on the heap for Python.
template <class T>
nb::capsule own(T* kept) {
    return nb::capsule(kept, [](void* pointer) noexcept { delete static_cast<T*>(pointer); });
}

// An array of rows that takes the vector's memory along.
template <class T>
nb::ndarray<nb::numpy, T> own_array(std::vector<T>&& values, std::size_t width = 0) {
    auto* kept = new std::vector<T>(std::move(values));
    const std::size_t shape[2] = {width == 0 ? kept->size() : kept->size() / width, width};
    return nb::ndarray<nb::numpy, T>(kept->data(), width == 0 ? 1 : 2, shape, own(kept));
}

// The same for pixels: (height, width, 3).
template <class T>
nb::ndarray<nb::numpy, T, nb::ndim<3>> own_pixels(std::vector<T>&& values, std::size_t height, std::size_t width) {
    auto* kept = new std::vector<T>(std::move(values));
    const std::size_t shape[3] = {height, width, 3};
    return nb::ndarray<nb::numpy, T, nb::ndim<3>>(kept->data(), 3, shape, own(kept));
}

// A column of a shared state that lives as long as either of its owners; `tail` is the shape of one row.
template <class Owner, class T>
nb::ndarray<nb::numpy, const T> share_array(const std::shared_ptr<const Owner>& shared, const std::vector<T>& values,
                                            const std::vector<std::size_t>& tail) {
    std::size_t width = 1;
    for (const std::size_t length : tail)
        width *= length;
    std::vector<std::size_t> shape{values.size() / width};
    shape.insert(shape.end(), tail.begin(), tail.end());
    return nb::ndarray<nb::numpy, const T>(values.data(), shape.size(), shape.data(), own(new auto(shared)));
}

inline Image take_image(const Pixels& pixels, std::map<std::string, std::string> attributes = {}) {
    return {static_cast<std::uint32_t>(pixels.shape(1)), static_cast<std::uint32_t>(pixels.shape(0)),
            std::vector<float>(pixels.data(), pixels.data() + pixels.size()), std::move(attributes)};
}

// Long work runs without the GIL; between chunks the callback is asked and signals are taken.
class PythonProgress {
public:
    explicit PythonProgress(nb::object callback) : m_callback(std::move(callback)) {}

    // Runs `work(progress)` without the GIL. What the callback or a signal raised comes out as it was raised.
    template <class Work>
    auto run(const Work& work) {
        const Progress progress{[this](std::string_view stage, double fraction) { return ask(stage, fraction); }};
        try {
            nb::gil_scoped_release release;
            return work(progress);
        } catch (const Cancelled&) {
            if (m_raised)
                std::rethrow_exception(m_raised);
            throw;
        }
    }

    // What was raised, where the work went on all the same.
    void raise() const {
        if (m_raised)
            std::rethrow_exception(m_raised);
    }

private:
    bool ask(std::string_view stage, double fraction) {
        nb::gil_scoped_acquire acquire;
        try {
            if (PyErr_CheckSignals() != 0)
                throw nb::python_error();
            if (m_callback.is_none())
                return true;
            const nb::object answer = m_callback(nb::str(stage.data(), stage.size()), fraction);
            return !(nb::isinstance<nb::bool_>(answer) && !nb::cast<bool>(answer));
        } catch (const nb::python_error&) {
            m_raised = std::current_exception();
            return false;
        }
    }

    nb::object m_callback;
    std::exception_ptr m_raised;
};

// A camera by its name, or by its place and axes.
CameraChoice read_camera(nb::handle given);

// settings, steps, notes, off_surface.
nb::dict describe_relaxation(const RelaxedRun& run);

void bind_settings(nb::module_& module);
void bind_device(nb::module_& module);
void bind_scene(nb::module_& module);
void bind_trace(nb::module_& module);
void bind_photons(nb::module_& module);
void bind_columns(nb::class_<Photons>& type);
void bind_script(nb::module_& module);
void bind_relax(nb::module_& module);
void bind_estimate(nb::module_& module);
void bind_image(nb::module_& module);
void bind_inspect(nb::module_& module);
void bind_inspect_images(nb::module_& module);
void bind_parallel_coordinates(nb::module_& module);
void bind_studio(nb::module_& module);

} // namespace photonloupe::bindings
