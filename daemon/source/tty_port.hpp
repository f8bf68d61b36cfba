#pragma once

#include "daemon/source/port.hpp"

namespace a351::daemon::source {

/// A tty by its descriptor.  A port in the kernel's tty class is set up with libserialport;
/// anything else, such as a pseudo-terminal, with termios alone.
class TtyPort : public Port {
public:
    /// @param device  not a link.
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

}  // namespace a351::daemon::source
