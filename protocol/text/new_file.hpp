#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace a351::text {

/// File that appears under its name only when it is complete, and leaves nothing behind otherwise.
///
/// All members throw std::system_error with the path if the operating system reports an error.
class NewFile {
public:
    /// Opens a temporary file beside `path`; the directory must exist.
    explicit NewFile(std::filesystem::path path);
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    ~NewFile();

    void write(std::string_view text);

    /// Completes the content.  `path` must be a regular file or must not exist.
    void close();

    /// Renames the closed file to `path`.
    void publish();

private:
    void require_good();

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::ofstream out_;
};

}  // namespace a351::text
