#include "sim/line/pty.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace a351::sim {
namespace {

[[noreturn]] void fail(const std::string& operation) {
    throw std::system_error(errno, std::generic_category(), operation);
}

}  // namespace

Pty::Pty(std::filesystem::path link) : link_(std::move(link)) {
    namespace fs = std::filesystem;
    if (fs::exists(fs::symlink_status(link_)) && !fs::is_symlink(link_)) {
        throw std::system_error(EEXIST, std::generic_category(),
                                link_.string() + " is no symbolic link");
    }
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    if (master_ < 0) fail("open a pseudo-terminal");
    std::array<char, 128> name{};
    if (::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, name.data(), name.size()) != 0) {
        ::close(master_);
        fail("unlock the pseudo-terminal");
    }
    slave_path_ = name.data();
    slave_ = ::open(slave_path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    if (slave_ < 0 || ::tcgetattr(slave_, &settings) != 0) {
        ::close(master_);
        fail("open " + slave_path_);
    }
    ::cfmakeraw(&settings);
    ::cfsetspeed(&settings, B460800);
    if (::tcsetattr(slave_, TCSANOW, &settings) != 0) fail("set up " + slave_path_);
    make_link();
}

void Pty::make_link() {
    namespace fs = std::filesystem;
    const fs::path fresh = link_.string() + "." + std::to_string(::getpid());
    fs::remove(fresh);
    fs::create_symlink(slave_path_, fresh);
    fs::rename(fresh, link_);
}

Pty::~Pty() {
    std::error_code ignored;
    if (std::filesystem::read_symlink(link_, ignored) == slave_path_) {
        std::filesystem::remove(link_, ignored);
    }
    ::close(slave_);
    ::close(master_);
}

std::vector<std::byte> Pty::read() {
    std::array<std::byte, 4096> buffer;
    const ssize_t got = ::read(master_, buffer.data(), buffer.size());
    if (got < 0) {
        if (errno == EAGAIN || errno == EINTR) return {};
        fail("read " + slave_path_);
    }
    return {buffer.begin(), buffer.begin() + got};
}

std::size_t Pty::write(std::span<const std::byte> bytes) {
    const ssize_t taken = ::write(master_, bytes.data(), bytes.size());
    if (taken >= 0) return static_cast<std::size_t>(taken);
    if (errno == EAGAIN || errno == EINTR) return 0;
    fail("write " + slave_path_);
}

void Pty::wait(bool for_space, std::chrono::nanoseconds timeout) {
    pollfd watched{master_, static_cast<short>(for_space ? POLLIN | POLLOUT : POLLIN), 0};
    const auto seconds = std::chrono::floor<std::chrono::seconds>(timeout);
    const timespec limit{seconds.count(), (timeout - seconds).count()};
    if (::ppoll(&watched, 1, &limit, nullptr) < 0 && errno != EINTR) fail("poll " + slave_path_);
}

bool Pty::is_drained() const {
    int waiting = 0;
    if (::ioctl(slave_, FIONREAD, &waiting) != 0) fail("ask " + slave_path_);
    return waiting == 0;
}

}  // namespace a351::sim
