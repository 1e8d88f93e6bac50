// SPDX-License-Identifier: Apache-2.0
// Drives the kernels that blend curves one over the other, or count and color them.
#include "inspect/parallel_plot.h"

#include <algorithm>
#include <cmath>

#include "gpu/commands.h"
#include "inspect/colormap.h"
#include "inspect/parallel_columns.h"

namespace photonloupe::inspect {
namespace {

constexpr std::uint32_t COLOR_COUNT = 256;
// Curves of the first dispatch, and the most of one: dispatches stay short while someone watches.
constexpr std::uint32_t BLEND_GRANULE = 256, LARGEST_BLEND = 512;
// As in shared/turns.glsl.
constexpr float TURN_BUDGET = 60000;
// On processors one part after the other; a graphics processor needs the invocations of many.
constexpr CountSplit SOFTWARE_SPLIT{16384, 1}, HARDWARE_SPLIT{4096, 8};
// Few invocations, each long: small workgroups spread them over all cores.
constexpr std::uint32_t WORKGROUP = 16;

// A set of curves on the device.
struct UploadedCurves {
    std::uint32_t count;
    std::uint32_t gap_count;
    gpu::Buffer coefficients, extents;

    UploadedCurves(gpu::Device& device, const Curves& curves, const AxisLayout& layout, bool needs_extents)
        : count(static_cast<std::uint32_t>(curves.count())), gap_count(static_cast<std::uint32_t>(curves.gap_count())) {
        if (is_empty())
            return;
        const Polynomials fitted = fit_polynomials(curves, layout);
        coefficients = gpu::make_buffer(device, fitted.coefficients, "curves");
        if (needs_extents)
            extents = gpu::make_buffer(device, fitted.extents, "extents of curves");
    }
    bool is_empty() const { return count == 0 || gap_count == 0; }
    // What a kernel that reads no extents may be given for them.
    const gpu::Buffer& get_extents() const { return extents.is_empty() ? coefficients : extents; }
};

CountSplit complete_split(const gpu::Device& device, const CountSplit& asked) {
    CountSplit split = device.info().type == "software" ? SOFTWARE_SPLIT : HARDWARE_SPLIT;
    if (asked.part_size > 0)
        split.part_size = std::min(asked.part_size, shared::LARGEST_PART);
    if (asked.part_count > 0)
        split.part_count = std::min(asked.part_count, shared::LARGEST_PART_COUNT);
    return split;
}

// Counts one set of curves in one band of rows.
class BandCount {
public:
    BandCount(gpu::Device& device, const AxisLayout& layout, const CountSplit& split, std::uint32_t row_count)
        : m_device(device), m_layout(layout), m_split(split), m_jobs(list_crossing_jobs(layout)),
          m_job_buffer(gpu::make_buffer(device, m_jobs.jobs, "crossing jobs")),
          m_column_jobs(gpu::make_buffer(device, m_jobs.column_jobs, "jobs of columns")),
          m_crossings(device, std::uint64_t{split.part_count} * (row_count + 2) * m_jobs.jobs.size() * 8, "crossings") {
    }

    void run(const UploadedCurves& curves, std::uint32_t first_row, std::uint32_t row_count, std::uint32_t set,
             const Coverage& coverage) {
        gpu::fill(m_device, "count crossings", m_crossings, 0);
        count_crossings(curves, first_row, row_count);
        gpu::Commands sum(m_device, "count coverage");
        const shared::CoverageSettings push{m_layout.width,     first_row, row_count, count_jobs(),
                                            m_split.part_count, set,       0,         0};
        sum.dispatch({"inspect/count_coverage.comp", WORKGROUP, {}, {}},
                     {{"column_jobs", m_column_jobs},
                      {"crossings", m_crossings},
                      {"coverage", coverage.counts},
                      {"largest", coverage.largest}},
                     push, m_layout.width);
        sum.run();
    }

private:
    std::uint32_t count_jobs() const { return static_cast<std::uint32_t>(m_jobs.jobs.size()); }

    void count_crossings(const UploadedCurves& curves, std::uint32_t first_row, std::uint32_t row_count) {
        const std::uint64_t chunk = std::uint64_t{m_split.part_size} * m_split.part_count;
        gpu::run_in_chunks(
            m_device, "count crossings", curves.count, chunk, {},
            [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                const std::uint64_t part_size = (count + m_split.part_count - 1) / m_split.part_count;
                shared::CrossingSettings push{.first_group = 0,
                                              .group_count = m_jobs.regular_group_count,
                                              .job_count = count_jobs(),
                                              .first_row = first_row,
                                              .row_count = row_count,
                                              .curve_count = curves.count,
                                              .first_curve = static_cast<std::uint32_t>(first),
                                              .end_curve = static_cast<std::uint32_t>(first + count),
                                              .part_size = static_cast<std::uint32_t>(part_size),
                                              .part_count = m_split.part_count};
                record(commands, curves, push, {});
                push.first_group = m_jobs.regular_group_count;
                push.group_count = m_jobs.ragged_group_count;
                record(commands, curves, push, {"RAGGED"});
            },
            chunk);
    }

    void record(gpu::Commands& commands, const UploadedCurves& curves, const shared::CrossingSettings& push,
                const std::vector<std::string>& defines) {
        const std::uint64_t invocations = std::uint64_t{push.group_count} * push.part_count;
        if (invocations > 0)
            commands.dispatch({"inspect/count_crossings.comp", WORKGROUP, defines, {}},
                              {{"jobs", m_job_buffer},
                               {"curves", curves.coefficients},
                               {"extents", curves.get_extents()},
                               {"crossings", m_crossings}},
                              push, invocations);
    }

    gpu::Device& m_device;
    const AxisLayout& m_layout;
    CountSplit m_split;
    CrossingJobs m_jobs;
    gpu::Buffer m_job_buffer, m_column_jobs, m_crossings;
};

void color_coverage(gpu::Device& device, const AxisLayout& layout, const Coverage& coverage, const CurveStyle& style,
                    const gpu::Buffer& pixels) {
    std::vector<glm::vec4> entries;
    for (std::uint32_t i = 0; i < COLOR_COUNT; ++i)
        entries.emplace_back(map_color(Colormap::viridis, (static_cast<float>(i) + 0.5f) / COLOR_COUNT), 1);
    const gpu::Buffer color_map = gpu::make_buffer(device, entries, "color map");
    const shared::PixelSettings push{
        style.background, glm::vec4(style.context_color, 1), layout.width * layout.height, 0, 0, 0};
    gpu::dispatch(
        device, "color coverage", {"inspect/color_coverage.comp", 64, {}, {}},
        {{"coverage", coverage.counts}, {"largest", coverage.largest}, {"color_map", color_map}, {"pixels", pixels}},
        push, push.pixel_count);
}

void draw_density(gpu::Device& device, const AxisLayout& layout, const Curves& context, const Curves& selected,
                  const CurveStyle& style, const gpu::Buffer& pixels) {
    const Coverage coverage = count_coverage(device, layout, context, selected);
    color_coverage(device, layout, coverage, style, pixels);
}

// The context's curves, all alike, then the selected ones, each in its color.
std::vector<glm::vec4> list_colors(std::size_t context_count, std::size_t selected_count,
                                   std::span<const glm::vec3> colors, const CurveStyle& style) {
    std::vector<glm::vec4> listed(context_count, glm::vec4(style.context_color, style.context_opacity));
    listed.resize(context_count + selected_count, glm::vec4(style.selected_color, style.opacity));
    for (std::size_t i = 0; i < std::min(selected_count, colors.size()); ++i)
        listed[context_count + i] = glm::vec4(colors[i], style.opacity);
    return listed;
}

Curves join(const Curves& first, const Curves& second) {
    Curves joined = first;
    joined.axis_count = std::max(first.axis_count, second.axis_count);
    joined.photons.insert(joined.photons.end(), second.photons.begin(), second.photons.end());
    joined.points.insert(joined.points.end(), second.points.begin(), second.points.end());
    joined.tangents.insert(joined.tangents.end(), second.tangents.begin(), second.tangents.end());
    return joined;
}

// Rows a curve covers in a column at most. No monotone cubic is steeper than three times its chord (Fritsch and
// Carlson 1980).
float find_most_rows(const Curves& curves, float line_width) {
    float steepest = 0;
    for (std::size_t i = 0; i < curves.count(); ++i)
        for (std::size_t a = 0; a + 1 < curves.axis_count; ++a) {
            const glm::vec2 step =
                curves.points[i * curves.axis_count + a + 1] - curves.points[i * curves.axis_count + a];
            steepest = std::max(steepest, 3 * std::abs(step.y / step.x)); // NaN is no curve, and not the larger
        }
    return steepest + line_width * std::sqrt(1 + steepest * steepest) + 2;
}

// Curves of one dispatch: an invocation has a turn for each and for each row that it covers, in up to two gaps.
std::uint32_t find_largest_blend(const Curves& curves, const AxisLayout& layout, float line_width) {
    const float row_count = static_cast<float>(std::min(layout.height, shared::LARGEST_BAND));
    const float turns = 1 + 2 * std::min(find_most_rows(curves, line_width), row_count);
    return std::clamp(static_cast<std::uint32_t>((TURN_BUDGET - 2 * row_count) / turns), 1u, LARGEST_BLEND);
}

void fill_background(gpu::Device& device, const CurveStyle& style, const gpu::Buffer& pixels) {
    std::uint32_t color = 0;
    for (std::size_t i = 0; i < 4; ++i)
        color |= static_cast<std::uint32_t>(std::clamp(style.background[i], 0.0f, 1.0f) * 255.0f + 0.5f) << (8 * i);
    gpu::fill(device, "blend curves", pixels, color);
}

void draw_each(gpu::Device& device, const AxisLayout& layout, const Curves& curves,
               const std::vector<glm::vec4>& colors, const CurveStyle& style, const gpu::Buffer& pixels) {
    const UploadedCurves uploaded(device, curves, layout, true);
    if (uploaded.is_empty())
        return fill_background(device, style, pixels);
    const gpu::Buffer column_gaps = gpu::make_buffer(device, list_column_gaps(layout), "gaps of columns");
    const gpu::Buffer color_buffer = gpu::make_buffer(device, colors, "colors of curves");
    const gpu::Buffer canvas(device, std::uint64_t{layout.width} * layout.height * sizeof(glm::uvec2), "canvas");
    shared::BlendSettings push{.background = style.background,
                               .width = layout.width,
                               .curve_count = uploaded.count,
                               .gap_count = uploaded.gap_count,
                               .line_width = style.line_width};
    const std::uint32_t largest = find_largest_blend(curves, layout, style.line_width);
    gpu::run_in_chunks(
        device, "blend curves", uploaded.count, std::min(BLEND_GRANULE, largest), {},
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            push.first_curve = static_cast<std::uint32_t>(first);
            push.end_curve = static_cast<std::uint32_t>(first + count);
            for (push.first_row = 0; push.first_row < layout.height; push.first_row += shared::LARGEST_BAND) {
                push.row_count = std::min(layout.height - push.first_row, shared::LARGEST_BAND);
                commands.dispatch({"inspect/blend_curves.comp", WORKGROUP, {}, {}},
                                  {{"column_gaps", column_gaps},
                                   {"curves", uploaded.coefficients},
                                   {"extents", uploaded.extents},
                                   {"colors", color_buffer},
                                   {"canvas", canvas},
                                   {"pixels", pixels}},
                                  push, layout.width);
            }
        },
        largest);
}

} // namespace

Coverage count_coverage(gpu::Device& device, const AxisLayout& layout, const Curves& context, const Curves& selected,
                        const CountSplit& split) {
    const std::uint64_t pixel_count = std::uint64_t{layout.width} * layout.height;
    Coverage coverage{gpu::Buffer(device, pixel_count * 8, "coverage"), gpu::Buffer(device, 8, "largest coverage")};
    gpu::Commands clear(device, "count coverage");
    clear.fill(coverage.counts, 0);
    clear.fill(coverage.largest, 0);
    clear.run();
    const std::uint32_t band = std::min(layout.height, shared::LARGEST_BAND);
    const bool has_closed =
        std::any_of(layout.places.begin(), layout.places.end(), [](const AxisPlace& place) { return place.rx > 0; });
    std::optional<BandCount> count;
    for (const std::uint32_t set : {0u, 1u}) {
        const UploadedCurves curves(device, set == 0 ? context : selected, layout, has_closed);
        if (curves.is_empty())
            continue;
        if (!count)
            count.emplace(device, layout, complete_split(device, split), band);
        for (std::uint32_t row = 0; row < layout.height; row += band)
            count->run(curves, row, std::min(band, layout.height - row), set, coverage);
    }
    return coverage;
}

CurveImage draw_curves(gpu::Device& device, const AxisLayout& layout, const Curves& context, const Curves& selected,
                       std::span<const glm::vec3> colors, const CurveStyle& style) {
    const std::uint64_t pixel_count = std::uint64_t{layout.width} * layout.height;
    CurveImage image{layout.width, layout.height, gpu::Buffer(device, pixel_count * 4, "curve image"), false};
    image.is_density = context.count() + selected.count() > style.most_curves;
    if (image.is_density)
        draw_density(device, layout, context, selected, style, image.pixels);
    else
        draw_each(device, layout, join(context, selected),
                  list_colors(context.count(), selected.count(), colors, style), style, image.pixels);
    return image;
}

std::vector<std::uint8_t> read_pixels(const CurveImage& image) {
    return image.pixels.read<std::uint8_t>(image.pixels.size_bytes());
}

} // namespace photonloupe::inspect
