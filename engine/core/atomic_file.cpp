// SPDX-License-Identifier: Apache-2.0
// Temporary sibling, fsync, rename, fsync of the folder (POSIX).
#include "core/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "core/error.h"

namespace photonloupe {
namespace {

// Threads of one process that write the same file at once take different names; more than this are an error.
constexpr int MAX_ATTEMPTS = 100;

[[noreturn]] void fail(const std::filesystem::path& path, const char* step, int error) {
    throw Error(path.string() + ": can't " + step + ": " + std::strerror(error) +
                "; check the folder, its permissions and the free space");
}

// Owns the temporary file until it was renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::filesystem::path& target) : m_target(target) {
        // O_EXCL skips names that another writer, or an earlier process that was killed, has taken.
        for (int attempt = 0; attempt < MAX_ATTEMPTS && m_descriptor < 0; ++attempt) {
            m_name = target.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
            m_descriptor = ::open(m_name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (m_descriptor < 0 && errno != EEXIST)
                break;
        }
        if (m_descriptor < 0)
            fail(m_target, "create a temporary file beside it", errno);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (m_descriptor >= 0)
            ::close(m_descriptor);
        if (!m_is_renamed)
            ::unlink(m_name.c_str());
    }

    void write(std::span<const unsigned char> bytes) {
        while (!bytes.empty()) {
            const ::ssize_t count = ::write(m_descriptor, bytes.data(), bytes.size());
            if (count < 0 && errno != EINTR)
                fail(m_target, "write", errno);
            if (count > 0)
                bytes = bytes.subspan(std::size_t(count));
        }
    }

    void move_to_target() {
        if (::fsync(m_descriptor) != 0)
            fail(m_target, "flush", errno);
        const int descriptor = m_descriptor;
        m_descriptor = -1;
        if (::close(descriptor) != 0)
            fail(m_target, "close", errno);
        if (::rename(m_name.c_str(), m_target.c_str()) != 0)
            fail(m_target, "rename the temporary file", errno);
        m_is_renamed = true;
    }

private:
    std::filesystem::path m_target;
    std::string m_name;
    int m_descriptor = -1;
    bool m_is_renamed = false;
};

// Makes the rename itself last; some file systems can't, which costs nothing but durability.
void sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
    if (descriptor < 0)
        return;
    ::fsync(descriptor);
    ::close(descriptor);
}

} // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const unsigned char> bytes) {
    TemporaryFile file(path);
    file.write(bytes);
    file.move_to_target();
    sync_folder(path.parent_path());
}

} // namespace photonloupe
