// SPDX-License-Identifier: Apache-2.0
// OpenEXR through memory streams, so that files are written whole and hostile sizes are met before allocation.
#include "image/exr.h"

#include <cstring>

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photonloupe {
namespace {

constexpr const char* RGB_CHANNELS[3] = {"R", "G", "B"};
constexpr std::size_t PIXEL_BYTES = 3 * sizeof(float);

class MemoryWriter final : public Imf::OStream {
public:
    MemoryWriter() : OStream("memory") {}

    void write(const char bytes[], int count) override {
        if (m_position + std::size_t(count) > m_bytes.size())
            m_bytes.resize(m_position + std::size_t(count));
        std::memcpy(m_bytes.data() + m_position, bytes, std::size_t(count));
        m_position += std::size_t(count);
    }
    std::uint64_t tellp() override { return m_position; }
    void seekp(std::uint64_t position) override { m_position = position; }

    const std::vector<unsigned char>& get_bytes() const { return m_bytes; }

private:
    std::vector<unsigned char> m_bytes;
    std::size_t m_position = 0;
};

class MemoryReader final : public Imf::IStream {
public:
    explicit MemoryReader(const std::vector<unsigned char>& bytes) : IStream("memory"), m_bytes(bytes) {}

    bool read(char bytes[], int count) override {
        if (count < 0 || m_position > m_bytes.size() || std::size_t(count) > m_bytes.size() - m_position)
            throw Error("the file ends too early");
        std::memcpy(bytes, m_bytes.data() + m_position, std::size_t(count));
        m_position += std::size_t(count);
        return m_position < m_bytes.size();
    }
    std::uint64_t tellg() override { return m_position; }
    void seekg(std::uint64_t position) override { m_position = position; }

private:
    const std::vector<unsigned char>& m_bytes;
    std::size_t m_position = 0;
};

Imf::Header make_header(const Image& image) {
    Imf::Header header(int(image.width), int(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : RGB_CHANNELS)
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec. 709
    for (const auto& [name, value] : image.attributes)
        header.insert(name, Imf::StringAttribute(value));
    return header;
}

void check_channels(const Imf::ChannelList& channels) {
    const bool is_rgb = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    std::string names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        names += std::string(names.empty() ? "" : ", ") + channel.name();
        const std::string name = channel.name();
        const bool is_read = is_rgb ? name == "R" || name == "G" || name == "B" : name == "Y";
        if (is_read && (channel.channel().xSampling != 1 || channel.channel().ySampling != 1))
            throw Error("channel " + name + " is subsampled");
    }
    if (!is_rgb && !channels.findChannel("Y"))
        throw Error("it has neither R, G and B nor Y, but " + (names.empty() ? "no channels" : names));
}

void read_pixels(Imf::InputFile& file, Image& image) {
    const Imath::Box2i window = file.header().dataWindow();
    const Imf::ChannelList& channels = file.header().channels();
    const bool is_rgb = channels.findChannel("R") != nullptr;
    image.rgb.resize(3ull * image.width * image.height);
    Imf::FrameBuffer frame;
    for (int i = 0; i < (is_rgb ? 3 : 1); ++i)
        frame.insert(is_rgb ? RGB_CHANNELS[i] : "Y", Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + i, window,
                                                                      PIXEL_BYTES, PIXEL_BYTES * image.width));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (std::size_t i = 0; !is_rgb && i < image.rgb.size(); i += 3)
        image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
}

Image decode(const std::vector<unsigned char>& bytes) {
    // Met while the header is parsed, before tables in proportion to the height are allocated.
    Imf::Header::setMaxImageSize(int(MAX_IMAGE_SIDE), int(MAX_IMAGE_SIDE));
    Imf::Header::setMaxTileSize(int(MAX_IMAGE_SIDE), int(MAX_IMAGE_SIDE));
    MemoryReader stream(bytes);
    Imf::InputFile file(stream, 0); // 0 threads: decoding happens in this one
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    check_image_size(std::uint64_t(width), std::uint64_t(height), "its header");
    check_channels(file.header().channels());
    Image image;
    image.width = std::uint32_t(width);
    image.height = std::uint32_t(height);
    for (auto entry = file.header().begin(); entry != file.header().end(); ++entry)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&entry.attribute()))
            image.attributes[entry.name()] = text->value();
    image.attributes.erase("type"); // written by some programs: the kind of EXR part, not provenance
    read_pixels(file, image);
    return image;
}

} // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
    check_image(image, path.string());
    MemoryWriter stream;
    try {
        const Imf::Header header = make_header(image);
        Imf::OutputFile file(stream, header, 0);
        Imf::FrameBuffer frame;
        for (int i = 0; i < 3; ++i) // OpenEXR takes writable pointers and only reads them here
            frame.insert(RGB_CHANNELS[i], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + i, header.dataWindow(),
                                                           PIXEL_BYTES, PIXEL_BYTES * image.width));
        file.setFrameBuffer(frame);
        file.writePixels(int(image.height));
    } catch (const std::exception& error) {
        throw Error(path.string() + ": can't be encoded as EXR: " + error.what() + "; check the attributes' names");
    }
    write_file_atomically(path, stream.get_bytes());
}

Image read_exr(const std::filesystem::path& path) {
    return decode_exr(path, read_image_file(path.string()));
}

Image decode_exr(const std::filesystem::path& path, const std::vector<unsigned char>& bytes) {
    try {
        return decode(bytes);
    } catch (const std::exception& error) {
        throw Error(path.string() + ": can't be read as EXR: " + error.what() + "; give an EXR file with R, G and B");
    }
}

} // namespace photonloupe
