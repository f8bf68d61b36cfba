#include "sim/line/place.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "protocol/core/input_error.hpp"

namespace a351::sim::line {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::error_code& error,
                         const std::string& allowed) {
    throw InputError(fmt::format("{}: {}; allowed: {}", path.string(), error.message(), allowed));
}

/// Opens the file as a writer would; removes it again if this made it.
std::error_code try_to_write(const fs::path& path, bool is_new) {
    const int flags = O_WRONLY | O_CLOEXEC | O_NONBLOCK | (is_new ? O_CREAT | O_EXCL : 0);
    const int file = ::open(path.c_str(), flags, 0600);
    if (file < 0) return {errno, std::generic_category()};
    ::close(file);
    if (is_new) ::unlink(path.c_str());
    return {};
}

}  // namespace

fs::file_status require_directory(const fs::path& path, const std::string& what) {
    const std::string allowed = what + " in a directory that exists";
    if (path.empty()) throw InputError("an empty path; allowed: " + allowed);
    const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(directory, error)) {
        throw InputError(fmt::format("{}: {} is no directory; allowed: {}", path.string(),
                                     directory.string(), allowed));
    }
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::status_known(status)) refuse(path, error, allowed);
    return status;
}

void require_file_place(const fs::path& path) {
    const bool is_new = !fs::exists(require_directory(path, "a file"));
    std::error_code error;
    if (!is_new && (!fs::exists(path, error) || fs::is_directory(path, error)))
        throw InputError(path.string() + ": exists and is no file; allowed: a file");
    error = try_to_write(path, is_new);
    if (error) refuse(path, error, "a file that can be written");
}

}  // namespace a351::sim::line
