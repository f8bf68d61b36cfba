#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace a351::sim {

/// A pseudo-terminal whose other side plays the serial port: raw, never blocking, named by a
/// symbolic link that is put in place atomically and removed at the end.  It holds its own slave
/// descriptor open, so that a host may come and go.
class Pty {
public:
    /// @throws std::system_error  naming the operation and the path; also when `link` exists and
    ///                            is not a symbolic link.
    explicit Pty(std::filesystem::path link);
    ~Pty();
    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    [[nodiscard]] const std::string& slave_path() const noexcept { return slave_path_; }

    /// What the host has written so far; empty if nothing.
    [[nodiscard]] std::vector<std::byte> read();

    /// @return how many bytes the terminal took, 0 when it is full.
    [[nodiscard]] std::size_t write(std::span<const std::byte> bytes);

    /// Waits until the host has written something, until the terminal takes bytes again if
    /// `for_space`, or until the time is over.
    void wait(bool for_space, std::chrono::nanoseconds timeout);

    /// The host has read everything that was written, as far as the kernel tells.
    [[nodiscard]] bool is_drained() const;

private:
    void make_link();

    int master_ = -1;
    int slave_ = -1;
    std::string slave_path_;
    std::filesystem::path link_;
};

}  // namespace a351::sim
