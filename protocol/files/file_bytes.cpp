#include "protocol/files/file_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "protocol/files/link_refused.hpp"

namespace a351::files {

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
    return read_bytes(file, 0, std::filesystem::file_size(file));
}

std::vector<std::byte> read_bytes(const std::filesystem::path& file, std::uint64_t offset,
                                  std::uint64_t count) {
    std::ifstream in(file, std::ios::binary);
    std::vector<std::byte> bytes(count);
    in.seekg(static_cast<std::streamoff>(offset));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
    if (!in) throw std::system_error(EIO, std::generic_category(), "read " + file.string());
    return bytes;
}

std::vector<std::byte> read_own_bytes(const std::filesystem::path& file, std::uint64_t offset,
                                      std::uint64_t count) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0 && errno == ELOOP) throw LinkRefused(file);
    std::vector<std::byte> bytes(count);
    std::size_t done = 0;
    while (descriptor >= 0 && done < count) {
        const ssize_t got = ::pread(descriptor, bytes.data() + done, count - done,
                                    static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    if (descriptor >= 0) ::close(descriptor);
    if (descriptor < 0 || done < count)
        throw std::system_error(EIO, std::generic_category(), "read " + file.string());
    return bytes;
}

}  // namespace a351::files
