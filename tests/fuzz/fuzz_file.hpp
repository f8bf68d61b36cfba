#pragma once
/// @file
/// Shared parts of the fuzzers: a check that ends the run, and files for readers that need one.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace a351::fuzz {

inline void require(bool holds) {
    if (!holds) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Returns a directory of this process, in memory if possible; it is removed when the process ends.
inline const std::filesystem::path& folder() {
    struct Folder {
        std::filesystem::path path;
        Folder()
            : path((std::filesystem::exists("/dev/shm") ? "/dev/shm"
                                                        : std::filesystem::temp_directory_path()) /
                   ("a351-fuzz-" + std::to_string(getpid()))) {
            std::filesystem::create_directories(path);
        }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
        Folder(const Folder&) = delete;
        Folder& operator=(const Folder&) = delete;
    };
    static const Folder folder;
    return folder.path;
}

/// Writes the input there and returns its path.
inline std::filesystem::path file_of(std::string_view bytes, const std::string& name) {
    const auto path = folder() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

}  // namespace a351::fuzz
