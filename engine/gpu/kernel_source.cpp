// SPDX-License-Identifier: Apache-2.0
// Expands a kernel's includes and turns its binding pragmas into storage, texel or address declarations.
#include "gpu/kernel_source.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <dlfcn.h>

#include "core/error.h"
#include "core/hash.h"
#include "gpu/compile_glsl.h"

namespace photonloupe::gpu {
namespace {

struct Expansion {
    std::vector<std::string> folders;
    std::set<std::string> seen;
    ExpandedSource result;
    std::ostringstream text;
};

BindingDeclaration parse_binding(const std::string& line, const std::string& where) {
    std::istringstream words(line);
    std::string pragma, binding;
    BindingDeclaration declaration;
    words >> pragma >> binding >> declaration.type;
    if (declaration.type == "texel") {
        declaration.kind = BindingKind::texel;
        declaration.type = "vec4";
    } else if (declaration.type == "readonly" || declaration.type == "writeonly" || declaration.type == "coherent") {
        declaration.qualifier = declaration.type;
        words >> declaration.type;
    }
    words >> declaration.name;
    std::string rest;
    if (declaration.name.empty() || (words >> rest && rest.rfind("//", 0) != 0))
        throw Error(where + ": expected '#pragma binding [readonly|writeonly|texel] TYPE NAME'");
    return declaration;
}

void append_file(Expansion& expansion, const std::string& path, const std::string& included_from);

void append_lines(Expansion& expansion, std::istream& lines, const std::string& path) {
    expansion.text << "#line 1 \"" << path << "\"\n";
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string where = path + ":" + std::to_string(number);
        if (line.rfind("#include \"", 0) == 0) {
            const std::size_t end = line.find('"', 10);
            append_file(expansion, line.substr(10, end - 10), " (included from " + where + ")");
            expansion.text << "#line " << number + 1 << " \"" << path << "\"\n";
        } else {
            if (line.rfind("#pragma binding", 0) == 0)
                expansion.result.bindings.push_back(parse_binding(line, where));
            expansion.text << line << '\n';
        }
    }
}

void append_file(Expansion& expansion, const std::string& path, const std::string& included_from) {
    if (!expansion.seen.insert(path).second)
        return;
    std::ifstream file;
    for (const std::string& folder : expansion.folders)
        if (!file.is_open())
            file.open(std::filesystem::path(folder) / path);
    if (!file.is_open())
        throw Error("kernel source '" + path + "' is missing" + included_from +
                    "; reinstall, or point PHOTONLOUPE_SHADER_DIR at the shaders folder");
    append_lines(expansion, file, path);
}

std::string declare_storage(const BindingDeclaration& binding, std::size_t index) {
    return "layout(set = 0, binding = " + std::to_string(index) + ", std430) " + binding.qualifier + " buffer " +
           binding.name + "_block { " + binding.type + " " + binding.name + "[]; };";
}

// A buffer too large for a descriptor: its address is entry `rank` of the block behind the last ordinary binding.
// Each pointer declares its own view of that block where its pragma stands, so that everything below can use it.
std::string declare_pointer(const BindingDeclaration& binding, std::size_t block, std::size_t rank) {
    return "layout(buffer_reference, std430, buffer_reference_align = 4) " + binding.qualifier + " buffer " +
           binding.name + "_pointer { " + binding.type +
           " data[]; };\nlayout(set = 0, binding = " + std::to_string(block) + ", std430) readonly buffer " +
           binding.name + "_address_block { layout(offset = " + std::to_string(rank * sizeof(std::uint64_t)) + ") " +
           binding.name + "_pointer " + binding.name + "_address; };\n#define " + binding.name + " " + binding.name +
           "_address.data";
}

// `name_at(i)` reads a texel binding however it is bound.
std::string declare_texels(const BindingDeclaration& binding, std::size_t index) {
    return "#define " + binding.name + "_at(i) texelFetch(" + binding.name +
           ", int(i))\nlayout(set = 0, binding = " + std::to_string(index) + ") uniform samplerBuffer " + binding.name +
           ";";
}

std::string declare_large(const BindingDeclaration& binding, std::size_t block, std::size_t rank) {
    const std::string pointer = declare_pointer(binding, block, rank);
    return binding.kind == BindingKind::texel ? "#define " + binding.name + "_at(i) " + binding.name + "[i]\n" + pointer
                                              : pointer;
}

// Where kernels are looked for, in this order: the folders of PHOTONLOUPE_SHADER_DIR (separated by ':'), else
// `shaders` beside the program.
std::vector<std::string> find_shader_folders() {
    if (const char* value = std::getenv("PHOTONLOUPE_SHADER_DIR"); value && *value) {
        std::vector<std::string> folders;
        std::istringstream list(value);
        for (std::string folder; std::getline(list, folder, ':');)
            folders.push_back(folder);
        return folders;
    }
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&find_shader_folders), &info) && info.dli_fname)
        return {(std::filesystem::absolute(info.dli_fname).parent_path() / "shaders").string()};
    return {"shaders"};
}

} // namespace

std::string make_key(const KernelSource& source) {
    std::string key = source.path + '|' + std::to_string(source.workgroup_size);
    for (const std::string& define : source.defines)
        key += '|' + define;
    for (std::uint32_t constant : source.constants)
        key += '#' + std::to_string(constant);
    if (!source.text.empty())
        key += '@' + hash_bytes(source.text);
    return key;
}

ExpandedSource expand_source(const KernelSource& source) {
    Expansion expansion;
    expansion.folders = find_shader_folders();
    if (source.text.empty()) {
        append_file(expansion, source.path, "");
    } else {
        std::istringstream lines(source.text);
        append_lines(expansion, lines, source.path);
    }
    expansion.result.text = expansion.text.str();
    return std::move(expansion.result);
}

std::string declare_bindings(const ExpandedSource& source, const std::vector<std::string>& defines,
                             std::uint64_t by_address) {
    std::ostringstream out;
    out << "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n";
    if (by_address)
        out << "#extension GL_EXT_buffer_reference : require\n";
    for (const std::string& define : defines)
        out << "#define " << define << '\n';
    std::istringstream in(source.text);
    std::string line;
    std::size_t index = 0, large = 0;
    while (std::getline(in, line)) {
        if (line.rfind("#pragma binding", 0) != 0) {
            out << line << '\n';
            continue;
        }
        const BindingDeclaration& binding = source.bindings[index];
        if (by_address >> index & 1)
            out << declare_large(binding, source.bindings.size(), large++) << '\n';
        else
            out << (binding.kind == BindingKind::texel ? declare_texels(binding, index)
                                                       : declare_storage(binding, index))
                << '\n';
        ++index;
    }
    return out.str();
}

std::vector<std::uint32_t> compile_generated(const KernelSource& source) {
    return compile_glsl(declare_bindings(expand_source(source), source.defines, 0), source.path);
}

} // namespace photonloupe::gpu
