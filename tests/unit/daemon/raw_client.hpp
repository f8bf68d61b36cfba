#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace a351::daemon {

/// A TCP connection to 127.0.0.1 that sends whatever bytes it is given.
class RawClient {
public:
    explicit RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const auto* any = reinterpret_cast<const sockaddr*>(&address);
        is_open_ = ::connect(socket_, any, sizeof address) == 0;
    }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;
    ~RawClient() { ::close(socket_); }

    [[nodiscard]] bool is_open() const noexcept { return is_open_; }

    /// Sends `bytes`.  Bytes that the daemon does not accept any more are silently dropped.
    void send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0) return;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
    }

    void finish_sending() const { ::shutdown(socket_, SHUT_WR); }

    /// Returns the next `count` bytes; fewer if the connection ends or nothing comes for 20 s.
    std::string take(std::size_t count) const {
        std::string received;
        while (received.size() < count) {
            const auto more = receive(count - received.size());
            if (!more || more->empty()) break;
            received += *more;
        }
        return received;
    }

    /// Returns everything up to the end of the connection.  After 20 s without a byte it appends
    /// "(no end)".
    std::string rest() const {
        std::string received;
        for (;;) {
            const auto more = receive(4096);
            if (!more) return received + "(no end)";
            if (more->empty()) return received;
            received += *more;
        }
    }

    /// Returns one response.  Its body is read by its Content-Length.
    std::string response() const {
        std::string received;
        while (received.find("\r\n\r\n") == std::string::npos) {
            const std::string byte = take(1);
            if (byte.empty()) return received;
            received += byte;
        }
        const auto mark = received.find("Content-Length: ");
        return mark == std::string::npos ? received
                                         : received + take(std::stoul(received.substr(mark + 16)));
    }

private:
    /// Returns bytes that have come; none at the end, std::nullopt if nothing comes for 20 s.
    std::optional<std::string> receive(std::size_t most) const {
        std::string bytes(most, '\0');
        pollfd ready{socket_, POLLIN, 0};
        if (::poll(&ready, 1, 20'000) <= 0) return std::nullopt;
        const auto got = ::recv(socket_, bytes.data(), most, 0);
        bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return bytes;
    }

    int socket_;
    bool is_open_ = false;
};

/// Returns the status code of a response; 0 if there is none.
inline int status_of(std::string_view response) {
    if (!response.starts_with("HTTP/1.1 ") || response.size() < 12) return 0;
    return std::stoi(std::string(response.substr(9, 3)));
}

}  // namespace a351::daemon
