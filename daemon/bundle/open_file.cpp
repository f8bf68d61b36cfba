#include "daemon/bundle/open_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace a351::daemon::bundle {
namespace {

[[noreturn]] void fail(int error, const std::filesystem::path& file) {
    throw std::system_error(error, std::generic_category(), file.string());
}

}  // namespace

// Without O_NONBLOCK a pipe in place of the file would be waited for.
OpenFile::OpenFile(const std::filesystem::path& file)
    : path_(file),
      descriptor_(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK)) {
    if (descriptor_ < 0) fail(errno, file);
    struct stat status {};
    const int error = fstat(descriptor_, &status) != 0 ? errno
                      : S_ISREG(status.st_mode)        ? 0
                                                       : EINVAL;
    if (error != 0) {
        ::close(descriptor_);
        fail(error, file);
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
    time_ = std::chrono::sys_seconds(std::chrono::seconds(status.st_mtim.tv_sec));
}

OpenFile::~OpenFile() { ::close(descriptor_); }

std::string OpenFile::read(std::uint64_t offset, std::uint64_t count) const {
    std::string bytes(count, '\0');
    std::size_t done = 0;
    while (done < count) {
        const ssize_t got = ::pread(descriptor_, bytes.data() + done, count - done,
                                    static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail(got < 0 ? errno : EIO, path_);
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

void OpenFile::sync() const {
    if (::fdatasync(descriptor_) != 0) fail(errno, path_);
}

void OpenFile::forget() const noexcept {
    static_cast<void>(::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_DONTNEED));
}

}  // namespace a351::daemon::bundle
