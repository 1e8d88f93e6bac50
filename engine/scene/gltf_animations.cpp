// SPDX-License-Identifier: Apache-2.0
// glTF 2.0, section 3.11: samplers, targets, keys.
#include "scene/gltf_animations.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it again";

Interpolation read_interpolation(const JsonPlace& place) {
    const std::string name = read_string_or(place, "LINEAR");
    if (name == "LINEAR")
        return Interpolation::linear;
    if (name == "STEP")
        return Interpolation::step;
    if (name == "CUBICSPLINE")
        return Interpolation::cubic;
    refuse(place, quote_text(name) + " is no interpolation", "use LINEAR, STEP or CUBICSPLINE");
}

std::optional<AnimatedPart> find_part(const std::string& path) {
    constexpr std::pair<const char*, AnimatedPart> PARTS[] = {{"translation", AnimatedPart::translation},
                                                              {"rotation", AnimatedPart::rotation},
                                                              {"scale", AnimatedPart::scale},
                                                              {"weights", AnimatedPart::weights}};
    for (const auto& [name, part] : PARTS)
        if (path == name)
            return part;
    return std::nullopt;
}

std::vector<double> read_numbers(const AccessorColumn& column, const JsonPlace& place) {
    if (column.count > MAX_ANIMATION_NUMBERS / column.width)
        refuse(place, "it has more than " + std::to_string(MAX_ANIMATION_NUMBERS) + " numbers", "thin out its keys");
    std::vector<double> numbers;
    numbers.reserve(column.count * column.width);
    for (std::uint64_t element = 0; element < column.count; ++element)
        for (std::uint32_t component = 0; component < column.width; ++component) {
            numbers.push_back(column.read(element, component));
            if (!std::isfinite(numbers.back()))
                refuse(place, "key " + std::to_string(element) + " is not finite", REMEDY);
        }
    return numbers;
}

void read_times(AnimationChannel& channel, const AccessorColumn& column, const JsonPlace& place) {
    if (column.width != 1)
        refuse(place, "times must be SCALAR", REMEDY);
    channel.times = read_numbers(column, place);
    for (std::size_t i = 1; i < channel.times.size(); ++i)
        if (!(channel.times[i] > channel.times[i - 1]))
            refuse(place, "its times do not increase at key " + std::to_string(i), REMEDY);
}

// Weights are SCALAR, as many for a key as there are morph targets.
void read_values(AnimationChannel& channel, const AccessorColumn& column, const JsonPlace& place) {
    channel.values = read_numbers(column, place);
    const std::size_t elements = channel.times.size() * (channel.interpolation == Interpolation::cubic ? 3 : 1);
    if (channel.part == AnimatedPart::weights)
        channel.width = static_cast<std::uint32_t>(channel.values.size() / elements);
    else
        channel.width = channel.part == AnimatedPart::rotation ? 4 : 3;
    const bool fits = channel.part == AnimatedPart::weights ? column.width == 1 : column.width == channel.width;
    if (!fits || channel.values.size() != elements * channel.width || channel.width == 0)
        refuse(place,
               "its " + std::to_string(column.count) + " values do not fit " + std::to_string(channel.times.size()) +
                   " keys",
               REMEDY);
}

std::optional<AnimationChannel> check_channel(const JsonPlace& animation, const JsonPlace& place,
                                              AccessorTable& accessors, const Json& nodes,
                                              std::vector<std::string>& ignored) {
    const JsonPlace target = require_member(place, "target");
    const auto node = read_index(find_member(target, "node"), nodes.size(), "node");
    const std::string path = read_string(require_member(target, "path"));
    AnimationChannel channel;
    const auto part = find_part(path);
    if (!node || !part || nodes[*node].contains("matrix")) {
        ignored.push_back(place.path + ": nothing that can be animated (" + path + ")");
        return std::nullopt;
    }
    channel.node = *node;
    channel.part = *part;
    const JsonPlace samplers = require_member(animation, "samplers");
    const auto index = *read_index(require_member(place, "sampler"), count_elements(samplers, MAX_ENTRIES), "sampler");
    const JsonPlace sampler = get_element(samplers, index);
    channel.interpolation = read_interpolation(find_member(sampler, "interpolation"));
    const JsonPlace input = require_member(sampler, "input"), output = require_member(sampler, "output");
    const AccessorColumn times = accessors.use(*read_index(input, accessors.get_count(), "accessor"));
    const AccessorColumn values = accessors.use(*read_index(output, accessors.get_count(), "accessor"));
    read_times(channel, times, input);
    read_values(channel, values, output);
    return channel;
}

} // namespace

std::vector<AnimationChannel> check_animations(const JsonPlace& root, AccessorTable& accessors, const Json& approved,
                                               std::vector<std::string>& ignored) {
    const JsonPlace animations = find_member(root, "animations");
    const std::size_t count = count_elements(animations, MAX_ENTRIES);
    std::vector<AnimationChannel> channels;
    if (count == 0)
        return channels;
    for (std::size_t i = 1; i < count; ++i)
        ignored.push_back(get_element(animations, i).path + ": only the first animation is played");
    const JsonPlace animation = get_element(animations, 0);
    const JsonPlace places = require_member(animation, "channels");
    const Json nodes = approved.value("nodes", Json::array());
    for (std::size_t i = 0; i < count_elements(places, MAX_ENTRIES); ++i)
        if (auto channel = check_channel(animation, get_element(places, i), accessors, nodes, ignored))
            channels.push_back(std::move(*channel));
    return channels;
}

} // namespace photonloupe
