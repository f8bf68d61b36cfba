#include "protocol/files/file_bytes.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

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

}  // namespace a351::files
