// SPDX-License-Identifier: Apache-2.0
// Puts a pass together: includes, declarations, the loop's body, what surrounds it.
#include "script/emit/emitter.h"
#include "script/emit/glsl_numbers.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

// The files of shaders/script/ that passes include where they need them, in order.
constexpr std::string_view LIBRARIES[] = {"positions",    "normals",    "powers",     "axes",  "paths", "path_vertices",
                                          "path_normals", "parameters", "colors",     "lanes", "pca",   "pca_words",
                                          "pca_lanes",    "neighbors",  "histograms", "prints"};

std::string indent(std::uint32_t depth) {
    return std::string(4 * depth, ' ');
}

} // namespace

EmittedPass Emitter::emit() {
    name_variables();
    plan_words();
    plan_slots();
    m_loops.push_back({true, {}});
    const Block body = capture([&] { emit(m_loop.statement->body); });
    m_pass.can_miss_photons = !m_has_element_reductions || m_loop.needs_fuel || !m_has_loops;
    m_pass.glsl = compose_head() + compose_declarations() + m_functions + "void run_body() {\n" + body.text + "}\n\n" +
                  compose_photon() + compose_main();
    if (m_pass.glsl.size() > MAX_GLSL_BYTES) {
        m_pass.too_long = Diagnostic{codes::PASS_TOO_LONG, Severity::error, m_loop.statement->span,
                                     "this loop over photons becomes " + std::to_string(m_pass.glsl.size() / 1024) +
                                         " KiB of GLSL; the limit is " + std::to_string(MAX_GLSL_BYTES / 1024) + " KiB",
                                     "split the loop, or call large functions in fewer places"};
        m_pass.glsl.clear();
    }
    return std::move(m_pass);
}

std::string Emitter::compose_head() {
    const std::uint32_t line = m_program.source.find_place(m_loop.statement->span.begin).line;
    std::string name;
    for (const char c : m_program.source.name)
        name += c < ' ' || c > '~' || c == '\\' ? '?' : c;
    std::string text = "// The loop over photons of " + name + ", line " + std::to_string(line) + ".\n" +
                       "#include \"shared/prelude.glsl\"\n#include \"shared/math.glsl\"\n" + "#define FAULT_WORDS " +
                       std::to_string(count_fault_words()) + "\n";
    if (m_pass.uniform_word_count > 0)
        text += "#pragma binding readonly uint uniform_words\n";
    if (m_has_loops)
        text += "#pragma binding uint late_bits\n";
    text += "#include \"script/pass.glsl\"\n#include \"script/numbers.glsl\"\n#include \"script/functions.glsl\"\n";
    for (const std::string_view library : LIBRARIES)
        if (m_libraries.contains(std::string(library)))
            text += "#include \"script/" + std::string(library) + ".glsl\"\n";
    return text + "\n";
}

std::string Emitter::declare_variable(std::uint32_t index, bool is_parameter) const {
    const Variable& v = variable(index);
    const std::string start = m_function_variables.contains(index) ? "    " : "";
    std::string text;
    const std::string type = name_type(v.type);
    const std::string& name = m_names.at(index);
    if (!is_parameter)
        text = start + type + " " + name + (v.array_size > 0 ? "[" + std::to_string(v.array_size) + "]" : "") +
               (v.type == Type::list && !start.empty() ? " = ivec2(0)" : "") + ";" +
               (v.type == Type::real ? " precise " + name + ";" : "") + "\n"; // in one, glslang makes globals local
    if (const auto flag = m_set_flags.find(index); flag != m_set_flags.end())
        text += start + "bool " + flag->second + (start.empty() ? "" : is_parameter ? " = true" : " = false") + ";\n";
    if (const auto photon = m_photon_names.find(index); photon != m_photon_names.end())
        text += start + "uint " + photon->second + ";\n";
    return text;
}

std::string Emitter::compose_declarations() const {
    std::string text;
    for (const auto& [size, type] : m_zeros) {
        text += "#define ZEROS_" + type + "_" + std::to_string(size) + " " + type + "[" + std::to_string(size) + "](";
        for (std::uint32_t i = 0; i < size; ++i)
            text += (i > 0 ? ", " : "") + std::string(type == "int" ? "0" : "ZERO");
        text += ")\n";
    }
    for (const auto& [index, use] : m_loop.variables) {
        const bool is_array = variable(index).array_size > 0;
        if (m_function_variables.contains(index) || (use.role == Role::uniform && (is_literal(index) || is_array)) ||
            (is_array && is_reduced(index)))
            continue;
        text += declare_variable(index);
    }
    if (m_uses_own_path)
        text += "uvec2 own_path;\n";
    if (m_loop.pca_2d != AccumulatorUse::unused)
        text += "Moments moments_2d;\n";
    if (m_loop.pca_3d != AccumulatorUse::unused)
        text += "Moments moments_3d;\n";
    if (m_loop.decomposition != AccumulatorUse::unused)
        text += "Decomposition decomposition;\n";
    return text + (text.empty() ? "" : "\n");
}

// What a photon that does not complete must leave as it was.
std::vector<Emitter::Register> Emitter::list_registers() const {
    std::vector<Register> registers;
    for (const ReducedSlots& slots : m_pass.lanes.variables) {
        if (variable(slots.variable).array_size > 0)
            continue;
        const Type type = variable(slots.variable).type;
        registers.push_back({name_type(type), m_names.at(slots.variable), slots.first,
                             type == Type::integer ? "load_integer" : "load_real", "store"});
        if (is_choice(slots.role)) // behind its value
            registers.push_back(
                {"uint", m_photon_names.at(slots.variable), slots.first + slots.size, "load_word", "store"});
    }
    if (m_pass.lanes.pca_2d)
        registers.push_back({"Moments", "moments_2d", *m_pass.lanes.pca_2d, "load_moments", "store_moments"});
    if (m_pass.lanes.pca_3d)
        registers.push_back({"Moments", "moments_3d", *m_pass.lanes.pca_3d, "load_moments", "store_moments"});
    return registers;
}

std::string Emitter::compose_start(std::uint32_t depth) const {
    std::string text = indent(depth) + "start_photon();\n";
    for (std::uint32_t word = 0; word < count_fault_words(); ++word)
        text += indent(depth) + "fault_bits[" + std::to_string(word) + "] = 0u;\n";
    if (m_libraries.contains("parameters"))
        text += indent(depth) + "staged_mask = 0u;\n";
    if (m_libraries.contains("colors"))
        text += indent(depth) + "staged_color = vec4(0.0);\n";
    if (m_libraries.contains("prints"))
        text += indent(depth) + "has_printed = false;\n";
    return text;
}

std::string Emitter::compose_finish() const {
    std::string text;
    if (m_loop.sets_parameters)
        for (int dimension = 3; dimension < 16; ++dimension)
            if (m_has_computed_dimensions || m_dimensions.contains(dimension))
                text += indent(2) + "write_parameter(" + std::to_string(dimension) + ");\n";
    if (m_libraries.contains("colors"))
        text += indent(2) + "write_color();\n";
    if (m_libraries.contains("prints"))
        text += indent(2) + "mark_print();\n";
    if (!text.empty())
        text = "    if (is_photon_complete() && is_committing) {\n" + text + "    }\n";
    if (!m_pass.sites.empty()) {
        text += "    if (has_turns_left() && !is_dry()) {\n";
        for (std::uint32_t word = 0; word < count_fault_words(); ++word)
            text += indent(2) + "count_faults(fault_bits[" + std::to_string(word) + "], " + std::to_string(32 * word) +
                    "u);\n";
        text += "    }\n";
    }
    return text;
}

// Without loops nothing can fail; else what was reduced is taken back. Elements in memory can't be: the body is run
// once without writing.
std::string Emitter::compose_photon() const {
    std::string text = "void run_photon() {\n    " + m_names.at(m_loop.statement->variable) + " = photon;\n";
    if (m_uses_own_path)
        text += "    own_path = find_path(photon);\n";
    std::string restore;
    if (m_has_loops)
        for (const Register& r : list_registers()) {
            text += "    " + r.type + " old_" + r.name + " = " + r.name + ";\n";
            restore += "        " + r.name + " = old_" + r.name + ";\n";
        }
    if (m_has_loops && m_loop.needs_fuel && m_has_element_reductions) {
        text += "    for (uint attempt = 0u; attempt < 2u; ++attempt) {\n" + compose_start(2) +
                "        is_committing = attempt == 1u && !is_dry();\n" + restore + "        run_body();\n" +
                "        ++turns;\n        if (!is_photon_complete()) break;\n    }\n";
    } else {
        text += compose_start(1) + "    is_committing = !is_dry();\n    run_body();\n";
    }
    if (!restore.empty())
        text += "    if (!is_photon_complete()) {\n" + restore + "    }\n";
    return text + compose_finish() + "}\n\n";
}

std::string Emitter::compose_loads() const {
    std::string text;
    for (const UniformSlot& slot : m_pass.uniforms) {
        const Variable& v = variable(slot.variable);
        const auto word = [&](std::uint32_t at) { return "uniform_words[" + std::to_string(at) + "u]"; };
        const std::string& name = m_names.at(slot.variable);
        if (slot.set_word)
            text += "    " + m_set_flags.at(slot.variable) + " = " + word(*slot.set_word) + " != 0u;\n";
        if (v.type == Type::list)
            text += "    " + name + " = ivec2(" + word(slot.first_word) + ", " + word(slot.first_word + 1) + ");\n";
        else if (v.array_size == 0)
            text += "    " + name + " = " + (v.type == Type::integer ? "int(" : "uintBitsToFloat(") +
                    word(slot.first_word) + ");\n";
    }
    const auto load = [&](const std::optional<std::uint32_t>& at, const std::string& name,
                          const std::string& function) {
        if (at)
            text += "    " + name + " = " + function + "(" + std::to_string(*at) + "u);\n";
    };
    load(m_pass.moments_2d_word, "moments_2d", "load_uniform_moments");
    load(m_pass.moments_3d_word, "moments_3d", "load_uniform_moments");
    load(m_pass.decomposition_word, "decomposition", "load_uniform_decomposition");
    return text;
}

std::string Emitter::compose_main() const {
    std::string text = "void main() {\n" + compose_loads() +
                       "    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;\n"
                       "    uint block = settings.first_block + group % settings.block_count;\n"
                       "    uint first_round = settings.first_round + group / settings.block_count * settings.rounds;\n"
                       "    uint lane = gl_LocalInvocationID.x;\n";
    const std::vector<Register> registers = list_registers();
    if (m_pass.lanes.slots > 0)
        text += "    lane_base = (block - settings.lane_block) * " + std::to_string(m_pass.lanes.slots) +
                "u * SCRIPT_LANES + lane;\n";
    for (const Register& r : registers)
        text += "    " + r.name + " = " + r.load + "(" + std::to_string(r.slot) + "u);\n";
    text += "    for (uint round = first_round; round < min(first_round + settings.rounds, SCRIPT_ROUNDS); ++round) {\n"
            "        photon = int(block * SCRIPT_BLOCK + round * SCRIPT_LANES + lane);\n"
            "        if (uint(photon) >= settings.photon_count) break;\n"
            "        ++turns;\n"
            "        run_photon();\n";
    if (m_has_loops)
        text += "        share_turns();\n"
                "        if (!has_turns_left()) {\n"
                "            atomicOr(late_bits[uint(photon) >> 5u], 1u << (uint(photon) & 31u));\n"
                "            break;\n"
                "        }\n";
    text += "    }\n";
    if (!registers.empty()) {
        text += "    if (!is_dry()) {\n";
        for (const Register& r : registers)
            text += "        " + r.store + "(" + std::to_string(r.slot) + "u, " + r.name + ");\n";
        text += "    }\n";
    }
    return text + "    report_turns();\n}\n";
}

EmittedPass emit_pass(const Program& program, const PhotonLoop& loop) {
    return Emitter(program, loop).emit();
}

} // namespace photonloupe::script
