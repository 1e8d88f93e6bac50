// SPDX-License-Identifier: Apache-2.0
// Walks a module's storage and push-constant blocks.
#include "gpu/reflect_spirv.h"

#include <memory>
#include <stdexcept>

#include <spirv_cross/spirv_cross_c.h>

namespace photonloupe::test {
namespace {

struct Reflector {
    std::unique_ptr<spvc_context_s, void (*)(spvc_context)> context{nullptr, spvc_context_destroy};
    spvc_compiler compiler = nullptr;
    Reflection result;

    void check(spvc_result code) const {
        if (code != SPVC_SUCCESS)
            throw std::runtime_error(spvc_context_get_last_error_string(context.get()));
    }

    void parse(const std::vector<std::uint32_t>& words) {
        spvc_context created = nullptr;
        check(spvc_context_create(&created));
        context.reset(created);
        spvc_parsed_ir module = nullptr;
        check(spvc_context_parse_spirv(created, words.data(), words.size(), &module));
        check(spvc_context_create_compiler(created, SPVC_BACKEND_NONE, module, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                           &compiler));
    }

    std::vector<spvc_reflected_resource> list_blocks(spvc_resource_type kind) const {
        spvc_resources resources = nullptr;
        check(spvc_compiler_create_shader_resources(compiler, &resources));
        const spvc_reflected_resource* list = nullptr;
        std::size_t count = 0;
        check(spvc_resources_get_resource_list_for_type(resources, kind, &list, &count));
        return {list, list + count};
    }

    ReflectedMember read_member(spvc_type type, spvc_type_id id, unsigned index) const {
        ReflectedMember member;
        member.name = spvc_compiler_get_member_name(compiler, id, index);
        check(spvc_compiler_type_struct_member_offset(compiler, type, index, &member.offset));
        std::size_t size = 0;
        check(spvc_compiler_get_declared_struct_member_size(compiler, type, index, &size));
        member.size_bytes = static_cast<std::uint32_t>(size);
        return member;
    }

    // Notes a struct and the structs inside it.
    void add_struct(spvc_type_id id, std::uint32_t array_stride) {
        const spvc_type_id base = spvc_type_get_base_type_id(spvc_compiler_get_type_handle(compiler, id));
        const spvc_type type = spvc_compiler_get_type_handle(compiler, base);
        if (spvc_type_get_basetype(type) != SPVC_BASETYPE_STRUCT)
            return;
        ReflectedStruct found;
        found.array_stride = array_stride;
        for (unsigned index = 0; index < spvc_type_get_num_member_types(type); ++index) {
            found.members.push_back(read_member(type, base, index));
            add_struct(spvc_type_get_member_type(type, index), 0);
        }
        result.structs[spvc_compiler_get_name(compiler, base)] = std::move(found);
    }

    void read_storage() {
        for (const spvc_reflected_resource& block : list_blocks(SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) {
            const spvc_type type = spvc_compiler_get_type_handle(compiler, block.base_type_id);
            unsigned stride = 0;
            if (spvc_compiler_type_struct_member_array_stride(compiler, type, 0, &stride) == SPVC_SUCCESS)
                add_struct(spvc_type_get_member_type(type, 0), stride);
        }
    }

    void read_push_constants() {
        for (const spvc_reflected_resource& block : list_blocks(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
            const spvc_type type = spvc_compiler_get_type_handle(compiler, block.base_type_id);
            for (unsigned index = 0; index < spvc_type_get_num_member_types(type); ++index) {
                const ReflectedMember member = read_member(type, block.base_type_id, index);
                result.push_bytes = member.offset + member.size_bytes;
                const spvc_type_id inner = spvc_type_get_member_type(type, index);
                if (spvc_type_get_basetype(spvc_compiler_get_type_handle(compiler, inner)) == SPVC_BASETYPE_STRUCT)
                    add_struct(inner, 0);
                else
                    result.push_constants.push_back(member);
            }
        }
    }
};

} // namespace

Reflection reflect_spirv(const std::vector<std::uint32_t>& words) {
    Reflector reflector;
    reflector.parse(words);
    reflector.read_storage();
    reflector.read_push_constants();
    return std::move(reflector.result);
}

} // namespace photonloupe::test
