#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace a351 {

/// The master side of a pseudo-terminal.
class Pty {
public:
    Pty() : descriptor_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
        if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0)
            throw std::runtime_error("no pseudo-terminal");
        path_ = ptsname(descriptor_);
    }
    ~Pty() { close_master(); }
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& path() const noexcept { return path_; }

    void close_master() {
        if (descriptor_ >= 0) close(descriptor_);
        descriptor_ = -1;
    }

    /// Waits up to `timeout` for bytes.  @return those that have come; empty if none have
    [[nodiscard]] std::vector<std::byte> read(std::chrono::milliseconds timeout) {
        pollfd waited{descriptor_, POLLIN, 0};
        poll(&waited, 1, static_cast<int>(timeout.count()));
        std::vector<std::byte> bytes(4096);
        const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
        bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
        return bytes;
    }

    /// Writes all bytes.  Waits while the other side does not read.
    /// @throws std::runtime_error  if it does not read for 1 s
    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
            if (count > 0) {
                bytes = bytes.subspan(static_cast<std::size_t>(count));
            } else {
                pollfd waited{descriptor_, POLLOUT, 0};
                if (poll(&waited, 1, 1000) <= 0) throw std::runtime_error("nobody reads the pty");
            }
        }
    }

private:
    int descriptor_;
    std::string path_;
};

}  // namespace a351
