// SPDX-License-Identifier: Apache-2.0
// Draco allocates by what headers say: counts are looked at before it does.
#include "scene/gltf_draco.h"

#include <cstring>
#include <memory>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <nlohmann/json.hpp>

#include "scene/limits.h"

namespace photonloupe {
namespace {

constexpr const char* REMEDY = "repair the file or export it without Draco compression";
// What KHR_draco_mesh_compression asks for.
constexpr int VERSION_MAJOR = 2, VERSION_MINOR = 2;
// Draco holds some 50 bytes per triangle and attribute with seams while it decodes: 1.6 GB.
constexpr std::uint64_t MAX_DRACO_TRIANGLES = 1u << 25;
// Attributes are decoded as 32-bit integers.
constexpr std::uint64_t DECODED_COMPONENT_BYTES = 4;

// Stops before attributes that memory would not hold: their number of components is anything in a broken file.
template <class Decoder>
class BoundedDecoder : public Decoder {
protected:
    bool DecodeAllAttributes() override {
        std::uint64_t bytes = 0;
        for (std::int32_t i = 0; i < this->point_cloud()->num_attributes(); ++i)
            bytes += std::uint64_t(this->point_cloud()->attribute(i)->num_components()) * DECODED_COMPONENT_BYTES *
                     this->point_cloud()->num_points();
        return bytes <= MAX_DECODED_BYTES && Decoder::DecodeAllAttributes();
    }
};

// Looks ahead at the counts by which Draco allocates.
bool is_bounded(draco::DecoderBuffer buffer, const draco::DracoHeader& header) {
    if (header.flags & METADATA_FLAG_MASK) {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
            return false;
    }
    std::uint32_t first = 0, second = 0;
    std::uint8_t traversal = 0, seam_count = 0;
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) // triangles, points
        return draco::DecodeVarint(&first, &buffer) && draco::DecodeVarint(&second, &buffer) &&
               std::uint64_t(first) + second <= MAX_DRACO_TRIANGLES;
    // vertices, triangles
    return buffer.Decode(&traversal) && draco::DecodeVarint(&first, &buffer) && draco::DecodeVarint(&second, &buffer) &&
           buffer.Decode(&seam_count) && (1 + std::uint64_t(seam_count)) * second + first <= MAX_DRACO_TRIANGLES;
}

std::unique_ptr<draco::Mesh> decode_mesh(std::span<const unsigned char> bytes, const JsonPlace& extension) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok() || header.version_major != VERSION_MAJOR ||
        header.version_minor != VERSION_MINOR || header.encoder_type != draco::TRIANGULAR_MESH)
        refuse(extension, "its data is no mesh of Draco 2.2", REMEDY);
    if (!is_bounded(ahead, header))
        refuse(extension, "its data is cut off, or has more triangles than are decoded at once", REMEDY);
    std::unique_ptr<draco::MeshDecoder> decoder;
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
        decoder = std::make_unique<BoundedDecoder<draco::MeshSequentialDecoder>>();
    else
        decoder = std::make_unique<BoundedDecoder<draco::MeshEdgebreakerDecoder>>();
    auto mesh = std::make_unique<draco::Mesh>();
    try {
        const draco::Status status = decoder->Decode(draco::DecoderOptions(), &buffer, mesh.get());
        if (status.ok() && mesh->num_faces() > 0 && mesh->num_points() > 0)
            return mesh;
    } catch (const std::bad_alloc&) {
        refuse(extension, "there is not enough memory for it", REMEDY);
    }
    refuse(extension, "its data can't be decompressed", REMEDY);
}

std::uint64_t find_component_type(const draco::PointAttribute& attribute, const JsonPlace& place) {
    switch (attribute.data_type()) {
    case draco::DT_INT8:
        return COMPONENT_BYTE;
    case draco::DT_UINT8:
        return COMPONENT_UNSIGNED_BYTE;
    case draco::DT_INT16:
        return COMPONENT_SHORT;
    case draco::DT_UINT16:
        return COMPONENT_UNSIGNED_SHORT;
    case draco::DT_UINT32:
        return COMPONENT_UNSIGNED_INT;
    case draco::DT_FLOAT32:
        return COMPONENT_FLOAT;
    default:
        refuse(place, "its numbers are of no kind that glTF has", REMEDY);
    }
}

// The attribute's values by point, as the accessor will read them.
void fill_attribute(const draco::Mesh& mesh, const JsonPlace& id, std::uint32_t accessor, AccessorTable& accessors) {
    const draco::PointAttribute* attribute =
        mesh.GetAttributeByUniqueId(std::uint32_t(read_unsigned(id, std::numeric_limits<std::uint32_t>::max())));
    if (!attribute)
        refuse(id, "the compressed data has no such attribute", REMEDY);
    AccessorColumn column;
    column.component_type = find_component_type(*attribute, id);
    column.width = std::uint32_t(attribute->num_components());
    column.count = mesh.num_points();
    column.element_bytes = column.stride =
        std::uint64_t(column.width) * std::uint64_t(draco::DataTypeLength(attribute->data_type()));
    if (attribute->byte_stride() != std::int64_t(column.stride) ||
        attribute->buffer()->data_size() < attribute->size() * column.stride)
        refuse(id, "its values are cut off", REMEDY);
    const std::span<unsigned char> bytes = accessors.allocate(id, column.count * column.stride);
    for (std::uint32_t i = 0; i < column.count; ++i) {
        const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute->size())
            refuse(id, "its values are cut off", REMEDY);
        attribute->GetValue(value, &bytes[i * column.stride]);
    }
    column.bytes = bytes.data();
    accessors.fill(accessor, column);
}

void fill_indices(const draco::Mesh& mesh, const JsonPlace& place, std::uint32_t accessor, AccessorTable& accessors) {
    AccessorColumn column;
    column.component_type = COMPONENT_UNSIGNED_INT;
    column.stride = column.element_bytes = sizeof(std::uint32_t);
    column.count = 3 * std::uint64_t(mesh.num_faces());
    const std::span<unsigned char> bytes = accessors.allocate(place, column.count * column.stride);
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t point = mesh.face(draco::FaceIndex(i))[corner].value();
            std::memcpy(&bytes[(3 * std::uint64_t(i) + corner) * sizeof point], &point, sizeof point);
        }
    column.bytes = bytes.data();
    accessors.fill(accessor, column);
}

} // namespace

bool decode_draco(const JsonPlace& primitive, AccessorTable& accessors) {
    const JsonPlace extension = find_member(find_member(primitive, "extensions"), "KHR_draco_mesh_compression");
    const JsonPlace attributes = find_member(primitive, "attributes");
    const auto positions = read_index(find_member(attributes, "POSITION"), accessors.get_count(), "accessor");
    if (!extension.value || !positions || find_member(accessors.get_place(*positions), "bufferView").value)
        return false;
    const auto indices = *read_index(require_member(primitive, "indices"), accessors.get_count(), "accessor");
    if (accessors.is_filled(*positions) && accessors.is_filled(indices))
        return true; // of another primitive with the same data
    const std::unique_ptr<draco::Mesh> mesh =
        decode_mesh(accessors.check_view_bytes(require_member(extension, "bufferView")), extension);
    const JsonPlace ids = require_member(extension, "attributes");
    const Json none = Json::object();
    for (const auto& [name, id] : (ids.value->is_object() ? *ids.value : none).items()) {
        const JsonPlace place = find_member(attributes, name.c_str());
        if (const auto accessor = read_index(place, accessors.get_count(), "accessor"))
            fill_attribute(*mesh, find_member(ids, name.c_str()), *accessor, accessors);
    }
    fill_indices(*mesh, extension, indices, accessors);
    return true;
}

} // namespace photonloupe
