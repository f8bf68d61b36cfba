#pragma once

#include <chrono>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "daemon/page/live_message.hpp"
#include "tests/unit/daemon/served.hpp"

namespace a351::daemon {

/// A client of the live stream with the minimum of RFC 6455: no fragments from the server.
class RawViewer {
public:
    enum Kind { text = 1, binary = 2, close = 8, ping = 9, pong = 10 };
    struct Frame {
        int kind = 0;
        std::string payload;
    };

    explicit RawViewer(const Served& served) : RawViewer(served, served.own_origin()) {}
    /// @param headers  headers to add to those of the upgrade, for example Origin
    RawViewer(const Served& served, const std::string& headers) : client_(served.server.port()) {
        client_.send(request(served.host(), headers));
        answer_ = client_.response();
    }

    static std::string request(const std::string& host, const std::string& headers) {
        return "GET /live HTTP/1.1\r\n" + host +
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
               headers + "\r\n";
    }

    [[nodiscard]] const std::string& answer() const noexcept { return answer_; }
    [[nodiscard]] int status() const { return status_of(answer_); }
    [[nodiscard]] const RawClient& client() const noexcept { return client_; }

    /// Returns the next message and answers pings; std::nullopt at the end of the connection.
    std::optional<Frame> next() const {
        for (;;) {
            const auto head = client_.take(2);
            if (head.size() < 2) return std::nullopt;
            std::size_t size = static_cast<unsigned char>(head[1]);
            if (size >= 126) {
                const auto length = client_.take(size == 126 ? 2 : 8);
                size = 0;
                for (const char byte : length) size = size << 8 | static_cast<unsigned char>(byte);
            }
            Frame frame{static_cast<unsigned char>(head[0]) & 15, client_.take(size)};
            if (frame.payload.size() < size) return std::nullopt;
            if (frame.kind != ping) return frame;
            send(pong, frame.payload);
        }
    }

    /// Returns the next message of a kind and drops others; std::nullopt also after 20 s.
    std::optional<Frame> next(Kind kind) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < end) {
            auto frame = next();
            if (!frame || frame->kind == kind) return frame;
        }
        return std::nullopt;
    }

    void send(Kind kind, const std::string& payload, bool is_last = true) const {
        std::string frame(1, static_cast<char>(kind | (is_last ? 0x80 : 0)));
        if (payload.size() < 126) {
            frame += static_cast<char>(0x80 | payload.size());
        } else {
            frame += {static_cast<char>(0x80 | 126), static_cast<char>(payload.size() >> 8 & 255),
                      static_cast<char>(payload.size() & 255)};
        }
        client_.send(frame + std::string(4, '\0') + payload);  // Masked with zeros.
    }

private:
    RawClient client_;
    std::string answer_;
};

/// A binary message, decoded as the format says.
struct ReadBlock {
    explicit ReadBlock(const std::string& bytes) {
        const auto get = [&](auto& value, std::size_t at) {
            std::memcpy(&value, bytes.data() + at, sizeof value);
        };
        if (bytes.size() < 32) return;
        get(version, 0);
        get(kind, 1);
        get(mask, 2);
        get(count, 4);
        get(first_index, 8);
        get(time_ms, 16);
        get(interval_ms, 24);
        std::size_t at = 32;
        for (auto& channel : counts) {
            for (std::uint32_t i = 0; i < count && at + 4 <= bytes.size(); ++i, at += 4) {
                std::int32_t value = 0;
                get(value, at);
                channel.push_back(value);
            }
        }
        is_whole = at == bytes.size();
    }
    [[nodiscard]] std::int64_t end_index() const { return first_index + count; }

    bool is_whole = false;
    std::uint8_t version = 0, kind = 0;
    std::uint16_t mask = 0;
    std::uint32_t count = 0;
    std::int64_t first_index = 0;
    double time_ms = 0.0, interval_ms = 0.0;
    std::array<std::vector<std::int32_t>, live::kLiveChannelCount> counts;
};

}  // namespace a351::daemon
