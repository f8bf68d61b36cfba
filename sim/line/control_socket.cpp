#include "sim/line/control_socket.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

#include "protocol/core/input_error.hpp"
#include "sim/line/place.hpp"

namespace a351::sim::line {
namespace {

namespace fs = std::filesystem;

sockaddr_un address_of(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.native().size() >= sizeof address.sun_path) {
        throw InputError(fmt::format("{}: too long for a socket; allowed: up to {} characters",
                                     path.string(), sizeof address.sun_path - 1));
    }
    std::memcpy(address.sun_path, path.c_str(), path.native().size() + 1);
    return address;
}

const sockaddr* plain(const sockaddr_un& address) {
    return reinterpret_cast<const sockaddr*>(&address);
}

bool is_listened_to(const sockaddr_un& address) {
    const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (probe < 0) return true;
    const bool refused =
        ::connect(probe, plain(address), sizeof address) != 0 && errno == ECONNREFUSED;
    ::close(probe);
    return !refused;
}

/// Returns true if a socket that may be replaced is at `path`.
/// @throws InputError  as ControlSocket::require_place().
bool has_stale_socket(const fs::path& path) {
    const fs::file_status status = require_directory(path, "a socket");
    const sockaddr_un address = address_of(path);
    if (!fs::exists(status)) return false;
    if (!fs::is_socket(status))
        throw InputError(path.string() + ": exists and is no socket; allowed: a new path");
    if (is_listened_to(address)) {
        throw InputError(path.string() +
                         ": another program listens on this socket; allowed: a new path");
    }
    return true;
}

}  // namespace

void ControlSocket::require_place(const fs::path& path) {
    static_cast<void>(has_stale_socket(path));
}

ControlSocket::ControlSocket(fs::path path, Handler handler)
    : path_(std::move(path)), handler_(std::move(handler)) {
    if (has_stale_socket(path_)) fs::remove(path_);
    const sockaddr_un address = address_of(path_);
    listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (listener_ < 0) throw std::system_error(errno, std::generic_category(), path_.string());
    struct stat file {};
    if (::bind(listener_, plain(address), sizeof address) != 0 ||
        ::listen(listener_, static_cast<int>(kMostClients)) != 0 ||
        ::lstat(path_.c_str(), &file) != 0) {
        const std::error_code error(errno, std::generic_category());
        ::close(listener_);
        throw InputError(fmt::format("{}: {}; allowed: a path where a socket can be made",
                                     path_.string(), error.message()));
    }
    device_ = file.st_dev;
    inode_ = file.st_ino;
}

ControlSocket::~ControlSocket() {
    for (const Client& client : clients_) ::close(client.descriptor);
    ::close(listener_);
    struct stat file {};
    if (::lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ && file.st_ino == inode_)
        ::unlink(path_.c_str());
}

void ControlSocket::serve(const device::Instant&) {
    greet();
    std::erase_if(clients_, [this](Client& client) {
        const bool is_there = read(client);
        if (write(client) && is_there) return false;
        ::close(client.descriptor);
        return true;
    });
}

void ControlSocket::greet() {
    for (;;) {
        const int descriptor = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (descriptor < 0) return;
        if (clients_.size() < kMostClients) {
            clients_.push_back({descriptor, {}, {}});
        } else {
            ::close(descriptor);
        }
    }
}

bool ControlSocket::read(Client& client) const {
    std::array<char, 4096> buffer;
    const ssize_t got = ::recv(client.descriptor, buffer.data(), buffer.size(), 0);
    if (got == 0) return false;
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    client.in.append(buffer.data(), static_cast<std::size_t>(got));
    for (std::size_t end; (end = client.in.find('\n')) != std::string::npos;) {
        client.out += answer(client.in.substr(0, end)) + '\n';
        client.in.erase(0, end + 1);
    }
    if (client.in.size() <= kLongestLine) return client.out.size() <= kMostUnread;
    client.out += fmt::format("error line too long; allowed: {} bytes\n", kLongestLine);
    return false;
}

bool ControlSocket::write(Client& client) const {
    if (client.out.empty()) return true;
    const ssize_t taken =
        ::send(client.descriptor, client.out.data(), client.out.size(), MSG_NOSIGNAL);
    if (taken < 0) return errno == EAGAIN || errno == EINTR;
    client.out.erase(0, static_cast<std::size_t>(taken));
    return true;
}

std::string ControlSocket::answer(const std::string& line) const {
    try {
        const std::string result = handler_(line);
        return result.empty() ? "ok" : "ok " + result;
    } catch (const std::exception& error) {
        return "error " + std::string(error.what());
    }
}

void ControlSocket::watch(std::vector<pollfd>& descriptors) const {
    descriptors.push_back({listener_, POLLIN, 0});
    for (const Client& client : clients_) {
        descriptors.push_back({client.descriptor,
                               static_cast<short>(client.out.empty() ? POLLIN : POLLIN | POLLOUT),
                               0});
    }
}

Nanoseconds ControlSocket::patience(const device::Instant&, const ClockScale&) const {
    return std::chrono::seconds(1);  // All its events wake a descriptor.
}

std::string execute(const std::string& line, const ControlActions& actions,
                    const FaultRules& rules) {
    if (line == "status") return actions.status();
    if (line == "edge") {
        actions.edge();
    } else if (line == "quit") {
        actions.quit();
    } else {
        actions.fault(parse_fault(line, rules));
    }
    return {};
}

}  // namespace a351::sim::line
