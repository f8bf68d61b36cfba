#include "daemon/source/tty_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace a351::daemon::source {
namespace {

// The kernel's own termios, because it holds the speed in use as a number.
constexpr unsigned kInputOff =
    IGNBRK | BRKINT | PARMRK | INPCK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | IXOFF | IXANY;
constexpr unsigned kLocalOff = ISIG | ICANON | ECHO | ECHOE | ECHOK | ECHONL | IEXTEN;
constexpr unsigned kControlOff = CSIZE | PARENB | CSTOPB | CRTSCTS;
constexpr int kLowLatency = static_cast<int>(ASYNC_LOW_LATENCY);
constexpr unsigned kControlOn = CS8 | CLOCAL | CREAD;

PortError failure(PortError::Kind kind, const std::filesystem::path& device, const char* step) {
    // Debian gives serial ports to the group dialout.
    const char* const remedy =
        errno == EACCES ? "; add the user to the group dialout, then log in again" : "";
    return {kind, device,
            fmt::format("{}: {}{}", step, std::generic_category().message(errno), remedy)};
}

unsigned speed_code(int baud, const std::filesystem::path& device) {
    if (baud == 460800) return B460800;
    if (baud == 230400) return B230400;
    if (baud == 115200) return B115200;
    throw PortError(PortError::Kind::settings, device,
                    fmt::format("{} baud is not supported", baud));
}

bool is_in_tty_class(const std::filesystem::path& device) {
    return device.parent_path() == "/dev" &&
           std::filesystem::exists("/sys/class/tty" / device.filename());
}

bool is_raw(const termios2& settings) {
    return (settings.c_iflag & kInputOff) == 0 && (settings.c_oflag & OPOST) == 0 &&
           (settings.c_lflag & kLocalOff) == 0 &&
           (settings.c_cflag & (kControlOff | kControlOn)) == kControlOn;
}

/// Requests the driver's low-latency mode.  Many drivers have none, or need rights for it.
/// @return  the settings in use, as text.
std::string ask_for_low_latency(int descriptor, const std::filesystem::path& device) {
    serial_struct serial{};
    bool is_low = false;
    if (ioctl(descriptor, TIOCGSERIAL, &serial) == 0) {
        serial.flags |= kLowLatency;
        ioctl(descriptor, TIOCSSERIAL, &serial);
        is_low = ioctl(descriptor, TIOCGSERIAL, &serial) == 0 && (serial.flags & kLowLatency) != 0;
    }
    std::string text = is_low ? ", low latency" : ", low latency not available";
    // Only FTDI's driver has this file.  Only root may write it; config/60-a351.rules lets udev do so.
    const auto timer = "/sys/class/tty" / device.filename() / "device/latency_timer";
    if (std::filesystem::exists(timer)) std::ofstream(timer) << 1;
    std::string timer_ms;
    std::ifstream(timer) >> timer_ms;
    if (!timer_ms.empty()) text += ", latency timer " + timer_ms + " ms";
    return text;
}

}  // namespace

TtyPort::TtyPort(const std::filesystem::path& device, int baud) {
    descriptor_ = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) {
        // EBUSY: another process set the exclusive flag.
        throw failure(errno == EBUSY ? PortError::Kind::locked : PortError::Kind::absent, device,
                      "cannot open");
    }
    try {
        lock(device);
        configure(device, baud);
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

TtyPort::~TtyPort() { close(descriptor_); }

void TtyPort::lock(const std::filesystem::path& device) {
    if (isatty(descriptor_) == 0)
        throw failure(PortError::Kind::settings, device, "not a serial port");
    // The lock comes before any change, because a change would disturb its holder.
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
        throw PortError(PortError::Kind::locked, device, "in use by another process");
}

void TtyPort::configure(const std::filesystem::path& device, int baud) {
    const bool is_real = is_in_tty_class(device);
    if (is_real) {
        configure_serial_port(device, baud);
        // Root ignores this flag; the lock above protects the port.  The flag is not set on a
        // pseudo-terminal, where it would outlive this process until the other side closes.
        ioctl(descriptor_, TIOCEXCL);
    }
    termios2 settings{};
    if (ioctl(descriptor_, TCGETS2, &settings) != 0)
        throw failure(PortError::Kind::settings, device, "cannot read the settings");
    settings.c_iflag &= ~kInputOff;
    settings.c_oflag &= ~static_cast<unsigned>(OPOST);
    settings.c_lflag &= ~kLocalOff;
    settings.c_cflag = (settings.c_cflag & ~kControlOff) | kControlOn;
    settings.c_cc[VMIN] = 1;  // A read of 0 bytes then means the end, never "no data yet".
    settings.c_cc[VTIME] = 0;
    if (!is_real) {
        settings.c_cflag =
            (settings.c_cflag & ~static_cast<unsigned>(CBAUD | CIBAUD)) | speed_code(baud, device);
    }
    termios2 kept{};
    if (ioctl(descriptor_, TCSETS2, &settings) != 0 || ioctl(descriptor_, TCGETS2, &kept) != 0)
        throw failure(PortError::Kind::settings, device, "cannot set 8N1 raw");
    if (!is_raw(kept) || kept.c_ospeed != static_cast<unsigned>(baud)) {
        throw PortError(PortError::Kind::settings, device,
                        "the port does not keep 8N1 raw without flow control at that speed");
    }
    description_ = fmt::format("{}, {} baud{}", device.string(), kept.c_ospeed,
                               ask_for_low_latency(descriptor_, device));
}

std::optional<std::size_t> TtyPort::read(std::span<std::byte> into,
                                         std::chrono::milliseconds timeout) {
    pollfd waited{descriptor_, POLLIN, 0};
    const int ready = poll(&waited, 1, static_cast<int>(timeout.count()));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return 0;
    if (ready < 0) return std::nullopt;
    const ssize_t count = ::read(descriptor_, into.data(), into.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR) && (waited.revents & POLLHUP) == 0)
        return 0;
    return std::nullopt;
}

bool TtyPort::write(std::span<const std::byte> bytes) {
    constexpr int kPatience_ms = 1000;
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count > 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(count));
        } else if (count < 0 && errno == EAGAIN) {
            pollfd waited{descriptor_, POLLOUT, 0};
            if (poll(&waited, 1, kPatience_ms) == 0) return false;
        } else if (count == 0 || errno != EINTR) {
            return false;
        }
    }
    return true;
}

}  // namespace a351::daemon::source
