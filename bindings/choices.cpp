// SPDX-License-Identifier: Apache-2.0
// The names of all choices, each once.
#include "choices.h"

#include "core/error.h"

namespace photonloupe::bindings {
namespace {

template <class T>
struct Choice {
    const char* name;
    T value;
};

template <class T, std::size_t Count>
T choose(const char* what, const std::string& given, const Choice<T> (&choices)[Count]) {
    std::string names;
    for (std::size_t i = 0; i < Count; ++i) {
        if (given == choices[i].name)
            return choices[i].value;
        names += std::string(i == 0 ? "" : i + 1 < Count ? ", " : " or ") + choices[i].name;
    }
    throw Error(std::string(what) + " is '" + given + "'; it must be " + names);
}

constexpr Choice<DensityKernel> KERNELS[]{{"epanechnikov", DensityKernel::epanechnikov},
                                          {"disc", DensityKernel::disc},
                                          {"cone", DensityKernel::cone},
                                          {"gaussian", DensityKernel::gaussian}};
constexpr Choice<RenderMode> MODES[]{{"composite", RenderMode::composite},     {"caustic", RenderMode::caustic},
                                     {"direct", RenderMode::direct},           {"photons", RenderMode::photons},
                                     {"false-color", RenderMode::false_color}, {"voronoi", RenderMode::voronoi}};
constexpr Choice<Emission> EMISSIONS[]{{"sobol", Emission::sobol}, {"random", Emission::random}};
constexpr Choice<Store> STORES[]{{"caustic", Store::caustic}, {"indirect", Store::indirect}, {"all", Store::all}};
constexpr Choice<Descriptor> DESCRIPTORS[]{{"none", Descriptor::none},
                                           {"gradient", Descriptor::gradient},
                                           {"pca", Descriptor::pca},
                                           {"tensor", Descriptor::tensor},
                                           {"split", Descriptor::split}};
constexpr Choice<Space> SPACES[]{{"world", Space::world}, {"parameter", Space::parameter}};
constexpr Choice<RadiusSearch> SEARCHES[]{{"exact", RadiusSearch::exact}, {"carried", RadiusSearch::carried}};
constexpr Choice<SearchSpace> SEARCH_SPACES[]{
    {"world", SearchSpace::world}, {"parameter", SearchSpace::parameter}, {"constrained", SearchSpace::constrained}};

} // namespace

DensityKernel parse_kernel(const std::string& name) {
    return choose("kernel", name, KERNELS);
}

RenderMode parse_mode(const std::string& name) {
    return choose("mode", name, MODES);
}

Emission parse_emission(const std::string& name) {
    return choose("emission", name, EMISSIONS);
}

Store parse_store(const std::string& name) {
    return choose("store", name, STORES);
}

Descriptor parse_descriptor(const std::string& name) {
    return choose("descriptor", name, DESCRIPTORS);
}

Space parse_space(const std::string& name) {
    return choose("space", name, SPACES);
}

RadiusSearch parse_search(const std::string& name) {
    return choose("search", name, SEARCHES);
}

SearchSpace parse_search_space(const std::string& name) {
    return choose("space", name, SEARCH_SPACES);
}

} // namespace photonloupe::bindings
