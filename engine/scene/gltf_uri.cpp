// SPDX-License-Identifier: Apache-2.0
// Data URIs and relative URIs, with every way out of the scene's folder closed.
#include "scene/gltf_uri.h"

#include <algorithm>
#include <string>

namespace photonloupe {
namespace {

constexpr const char* RELATIVE_REMEDY = "put the file into the scene's folder and name it by a relative path";
constexpr std::string_view BASE64_MARK = ";base64,"; // exporters write many media types before it

int decode_hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

int decode_base64_digit(char c) {
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    if (c == '+')
        return 62;
    return c == '/' ? 63 : -1;
}

std::vector<unsigned char> decode_base64(std::string_view text, const JsonPlace& place) {
    if (text.size() % 4 == 0 && text.ends_with('='))
        text.remove_suffix(text.ends_with("==") ? 2 : 1);
    if (text.size() % 4 == 1)
        refuse(place, "the base64 text has an impossible length", "export it again");
    std::vector<unsigned char> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const int digit = decode_base64_digit(c);
        if (digit < 0)
            refuse(place, "the base64 text has a character that is no base64 digit", "export it again");
        bits = (bits << 6 | std::uint32_t(digit)) & 0xFFFFFFu;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes.push_back(static_cast<unsigned char>(bits >> bit_count));
        }
    }
    return bytes;
}

std::string decode_percent(std::string_view uri, const JsonPlace& place) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            decoded += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? decode_hex_digit(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? decode_hex_digit(uri[i + 2]) : -1;
        if (high < 0 || low < 0)
            refuse(place, quote_text(uri) + " has a broken percent escape", "write %25 for a percent sign");
        decoded += char(high * 16 + low);
        i += 2;
    }
    return decoded;
}

// `path` lies in or below `folder`, component by component ("/a/bc" is not below "/a/b").
bool is_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto [folder_end, path_end] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return folder_end == folder.end() && path_end != path.end();
}

void check_path_text(const std::string& path, std::string_view uri, const JsonPlace& place) {
    if (path.empty())
        refuse(place, "the URI is empty", RELATIVE_REMEDY);
    if (path.find('\0') != std::string::npos)
        refuse(place, quote_text(uri) + " contains NUL", RELATIVE_REMEDY);
    if (path.find('\\') != std::string::npos)
        refuse(place, quote_text(uri) + " contains a backslash", "separate folders with /");
    if (path.front() == '/')
        refuse(place, quote_text(uri) + " is an absolute path", RELATIVE_REMEDY);
    if (path.substr(0, path.find('/')).find(':') != std::string::npos)
        refuse(place, quote_text(uri) + " has a scheme or a drive", RELATIVE_REMEDY);
}

} // namespace

std::optional<std::vector<unsigned char>> decode_data_uri(std::string_view uri, const JsonPlace& place) {
    if (!uri.starts_with("data:"))
        return std::nullopt;
    const std::size_t comma = std::min(uri.find(','), uri.size() - 1);
    if (!uri.substr(0, comma + 1).ends_with(BASE64_MARK))
        refuse(place, quote_text(uri.substr(0, comma)) + " is not a data URI of a buffer",
               "use data:application/octet-stream;base64,");
    return decode_base64(uri.substr(comma + 1), place);
}

std::vector<unsigned char> decode_image_uri(std::string_view uri, const JsonPlace& place) {
    constexpr std::string_view MARK = ";base64,";
    const std::size_t mark = uri.find(MARK);
    if (mark == std::string_view::npos)
        refuse(place, "the image's data URI is not base64", "use data:image/png;base64,");
    return decode_base64(uri.substr(mark + MARK.size()), place);
}

std::filesystem::path resolve_uri(std::string_view uri, const std::filesystem::path& folder, const JsonPlace& place) {
    const std::string relative = decode_percent(uri, place);
    check_path_text(relative, uri, place);
    if (folder.empty())
        refuse(place, quote_text(uri) + " names a file, but this scene has no folder", "embed the data");
    std::error_code error;
    const std::filesystem::path root = std::filesystem::canonical(folder, error);
    if (error)
        refuse(place, "the scene's folder " + quote_text(folder.string()) + ": " + error.message(), "check the folder");
    const std::filesystem::path resolved = std::filesystem::weakly_canonical(root / relative, error);
    if (error)
        refuse(place, quote_text(uri) + ": " + error.message(), RELATIVE_REMEDY);
    if (!is_below(resolved, root))
        refuse(place, quote_text(uri) + " leads out of the scene's folder", RELATIVE_REMEDY);
    return resolved;
}

} // namespace photonloupe
