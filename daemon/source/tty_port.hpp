#pragma once

#include "daemon/source/port.hpp"

namespace a351::daemon {

/// A tty by its descriptor.  A port that the kernel lists in its tty class is set up by
/// libserialport; a pseudo-terminal, or whatever else is not there, by termios alone.
class TtyPort : public Port {
public:
    /// @param device  no link.
    /// @throws PortError
    TtyPort(const std::filesystem::path& device, int baud);
    ~TtyPort() override;
    TtyPort(const TtyPort&) = delete;
    TtyPort& operator=(const TtyPort&) = delete;

    [[nodiscard]] std::optional<std::size_t> read(std::span<std::byte> into,
                                                  std::chrono::milliseconds timeout) override;
    [[nodiscard]] bool write(std::span<const std::byte> bytes) override;
    [[nodiscard]] const std::string& description() const noexcept override { return description_; }

private:
    void lock(const std::filesystem::path& device);
    void configure(const std::filesystem::path& device, int baud);

    int descriptor_ = -1;
    std::string description_;
};

}  // namespace a351::daemon
