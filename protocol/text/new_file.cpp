#include "protocol/text/new_file.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace a351::text {

NewFile::NewFile(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(path_.parent_path() /
                 fmt::format(".{}.{}.part", path_.filename().string(), ::getpid())) {
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::trunc);
    require_good();
}

NewFile::~NewFile() {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);  // already renamed after publish()
}

void NewFile::write(std::string_view text) {
    errno = 0;
    out_ << text;
    require_good();
}

void NewFile::close() {
    errno = 0;
    out_.close();
    require_good();
    // A rename onto a device or a link would replace it.
    const auto type = std::filesystem::symlink_status(path_).type();
    if (type != std::filesystem::file_type::not_found &&
        type != std::filesystem::file_type::regular) {
        throw std::system_error(EEXIST, std::generic_category(),
                                path_.string() + ": is not a regular file");
    }
}

void NewFile::publish() { std::filesystem::rename(temporary_, path_); }

void NewFile::require_good() {
    if (out_) return;
    throw std::system_error(errno == 0 ? EIO : errno, std::generic_category(),
                            temporary_.string() + ": cannot be written");
}

}  // namespace a351::text
