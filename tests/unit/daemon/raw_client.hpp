#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
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
        std::string received(count, '\0');
        std::size_t filled = 0;
        while (filled < count) {
            pollfd ready{socket_, POLLIN, 0};
            if (::poll(&ready, 1, 20'000) <= 0) break;
            const auto got = ::recv(socket_, received.data() + filled, count - filled, 0);
            if (got <= 0) break;
            filled += static_cast<std::size_t>(got);
        }
        received.resize(filled);
        return received;
    }

    /// Returns everything up to the end of the connection.  After 20 s without a byte it appends
    /// "(no end)".
    std::string rest() const {
        std::string received;
        char bytes[4096];
        for (;;) {
            pollfd ready{socket_, POLLIN, 0};
            if (::poll(&ready, 1, 20'000) <= 0) return received + "(no end)";
            const auto got = ::recv(socket_, bytes, sizeof bytes, 0);
            if (got <= 0) return received;
            received.append(bytes, static_cast<std::size_t>(got));
        }
    }

    /// Returns one response.  Its body is read by its Content-Length.
    std::string response() const {
        std::string received;
        char byte = 0;
        while (received.find("\r\n\r\n") == std::string::npos) {
            pollfd ready{socket_, POLLIN, 0};
            if (::poll(&ready, 1, 20'000) <= 0 || ::recv(socket_, &byte, 1, 0) <= 0) {
                return received;
            }
            received += byte;
        }
        const auto mark = received.find("Content-Length: ");
        auto left = mark == std::string::npos ? 0UL : std::stoul(received.substr(mark + 16));
        for (; left > 0 && ::recv(socket_, &byte, 1, 0) > 0; --left) received += byte;
        return received;
    }

private:
    int socket_;
    bool is_open_ = false;
};

/// Returns the status code of a response; 0 if there is none.
inline int status_of(std::string_view response) {
    if (!response.starts_with("HTTP/1.1 ") || response.size() < 12) return 0;
    return std::stoi(std::string(response.substr(9, 3)));
}

}  // namespace a351::daemon
