#include "sim/line/pty.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "protocol/core/input_error.hpp"
#include "sim/line/place.hpp"

namespace a351::sim::line {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to(const std::string& operation) {
    throw std::system_error(errno, std::generic_category(), operation);
}

constexpr int kRefill_ms = 20;

struct Speed {
    int baud;
    speed_t code;
};
constexpr std::array kSpeeds{
    Speed{1200, B1200},     Speed{2400, B2400},     Speed{4800, B4800},     Speed{9600, B9600},
    Speed{19200, B19200},   Speed{38400, B38400},   Speed{57600, B57600},   Speed{115200, B115200},
    Speed{230400, B230400}, Speed{460800, B460800}, Speed{921600, B921600},
};

speed_t speed_code(int baud) {
    const auto found = std::ranges::find(kSpeeds, baud, &Speed::baud);
    if (found == kSpeeds.end()) {
        throw std::invalid_argument(fmt::format("no terminal has a speed of {} baud", baud));
    }
    return found->code;
}

/// Returns true if a link that may be replaced is at the path.
/// @throws InputError  as Pty::require_place().
bool has_stale_link(const fs::path& link) {
    const fs::file_status status = require_directory(link, "a link");
    if (!fs::exists(status)) return false;
    if (!fs::is_symlink(status)) {
        throw InputError(link.string() +
                         ": exists and is no link; allowed: a new path, or a link left behind");
    }
    std::error_code error;
    const fs::path target = fs::read_symlink(link, error);
    if (target.parent_path() != "/dev/pts" || fs::exists(target, error)) {
        throw InputError(fmt::format(
            "{}: leads to {}; allowed: a new path, or a link to a terminal that is gone",
            link.string(), target.string()));
    }
    return true;
}

}  // namespace

Pty::Terminal::Terminal(int baud) : master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (master < 0) fail_to("open a pseudo-terminal");
    try {
        open_slave(baud);
    } catch (...) {
        if (slave >= 0) ::close(slave);
        ::close(master);
        throw;
    }
}

void Pty::Terminal::open_slave(int baud) {
    std::array<char, 128> name{};
    if (::fcntl(master, F_SETFL, O_NONBLOCK) != 0 || ::grantpt(master) != 0 ||
        ::unlockpt(master) != 0 || ::ptsname_r(master, name.data(), name.size()) != 0) {
        fail_to("unlock the pseudo-terminal");
    }
    path = name.data();
    slave = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    termios settings{};
    if (slave < 0 || ::tcgetattr(slave, &settings) != 0) fail_to("open " + path);
    ::cfmakeraw(&settings);
    ::cfsetspeed(&settings, speed_code(baud));
    if (::tcsetattr(slave, TCSANOW, &settings) != 0) fail_to("set up " + path);
}

Pty::Terminal::~Terminal() {
    ::close(slave);
    ::close(master);
}

void Pty::require_place(const fs::path& link) { static_cast<void>(has_stale_link(link)); }

Pty::Pty(fs::path link, int baud)
    : link_(std::move(link)), baud_(baud), terminal_(std::make_unique<Terminal>(baud)) {
    come_back();
}

Pty::~Pty() { remove_link(); }

void Pty::come_back() {
    std::error_code error;
    if (has_stale_link(link_)) fs::remove(link_, error);
    fs::create_symlink(terminal_->path, link_, error);
    if (error) {
        throw InputError(fmt::format("{}: {}; allowed: a path where a link can be made",
                                     link_.string(), error.message()));
    }
}

void Pty::remove_link() noexcept {
    std::error_code ignored;
    if (fs::read_symlink(link_, ignored) == terminal_->path) fs::remove(link_, ignored);
}

void Pty::hang_up() {
    auto next = std::make_unique<Terminal>(baud_);  // The old one is open: its name differs.
    remove_link();
    terminal_ = std::move(next);
}

std::size_t Pty::discard_unread() {
    std::array<std::byte, 4096> buffer;
    std::size_t count = 0;
    // The kernel refills the terminal from its own buffer a little later.
    for (pollfd more{terminal_->slave, POLLIN, 0}; ::poll(&more, 1, kRefill_ms) > 0;) {
        const ssize_t got = ::read(terminal_->slave, buffer.data(), buffer.size());
        if (got <= 0) break;
        count += static_cast<std::size_t>(got);
    }
    return count;
}

std::vector<std::byte> Pty::read() {
    std::array<std::byte, 4096> buffer;
    const ssize_t got = ::read(terminal_->master, buffer.data(), buffer.size());
    if (got < 0) {
        if (errno == EAGAIN || errno == EINTR) return {};
        fail_to("read " + terminal_->path);
    }
    return {buffer.begin(), buffer.begin() + got};
}

std::size_t Pty::write(std::span<const std::byte> bytes) {
    const ssize_t taken = ::write(terminal_->master, bytes.data(), bytes.size());
    if (taken >= 0) return static_cast<std::size_t>(taken);
    if (errno == EAGAIN || errno == EINTR) return 0;
    fail_to("write " + terminal_->path);
}

pollfd Pty::watched(bool for_space) const noexcept {
    return {terminal_->master, static_cast<short>(for_space ? POLLIN | POLLOUT : POLLIN), 0};
}

int Pty::baud() const {
    termios settings{};
    if (::tcgetattr(terminal_->slave, &settings) != 0) fail_to("ask " + terminal_->path);
    const auto found = std::ranges::find(kSpeeds, ::cfgetospeed(&settings), &Speed::code);
    return found == kSpeeds.end() ? 0 : found->baud;
}

std::size_t Pty::unread() const {
    // FIONREAD does not count bytes that the kernel's worker has not delivered yet.  If none are
    // there, poll() waits for the worker.
    pollfd delivered{terminal_->slave, POLLIN, 0};
    static_cast<void>(::poll(&delivered, 1, 0));
    int waiting = 0;
    if (::ioctl(terminal_->slave, FIONREAD, &waiting) != 0) fail_to("ask " + terminal_->path);
    return static_cast<std::size_t>(waiting);
}

}  // namespace a351::sim::line
