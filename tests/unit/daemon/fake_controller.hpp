#pragma once
/// @file
/// A temperature controller on a pseudo-terminal.  A test chooses how it answers or fails to.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sim/oven/modbus_frame.hpp"
#include "tests/unit/daemon/pty.hpp"

namespace a351 {

class FakeController {
public:
    enum class Manner {
        good,
        mute,
        half,           ///< The first half of the answer only.
        bad_crc,        ///< One bit of the CRC is wrong.
        refused,        ///< Exception 02.
        other_unit,     ///< An answer from the next unit number.
        babble,         ///< 64 bytes like another unit's answer, with a wrong CRC.
        own_babble,     ///< 64 bytes like an answer of this unit, with a wrong CRC.
        other_question  ///< Fewer registers than requested.
    };
    std::atomic<Manner> manner{Manner::good};           ///< How requests for 2000h are answered.
    std::atomic<Manner> decimals_manner{Manner::good};  ///< How requests for 2410h are answered.
    std::atomic<std::uint16_t> decimals{1};
    std::atomic<bool> is_four_byte{false};  ///< Accepts 0000h and 0420h, refuses 2000h and 2410h.
    std::atomic<std::chrono::milliseconds> delay{};  ///< Delay of answers for 2000h.
    std::atomic<int> polls{0}, decimal_requests{0};
    std::atomic<int> other_requests{0};  ///< Requests with other functions, addresses or counts.

    FakeController() : thread_([this] { run(); }) {}
    ~FakeController() { switch_off(); }
    FakeController(const FakeController&) = delete;
    FakeController& operator=(const FakeController&) = delete;

    [[nodiscard]] const std::string& path() const noexcept { return pty_.path(); }

    /// Closes the terminal, as if the adapter were pulled out.
    void switch_off() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        pty_.close_master();
    }

private:
    using Bytes = std::vector<std::byte>;

    void run() {
        Bytes received;
        while (!stop_) {
            const auto bytes = pty_.read(std::chrono::milliseconds(2));
            // Without a host the terminal is always readable.
            if (bytes.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            received.insert(received.end(), bytes.begin(), bytes.end());
            if (received.size() < 8) continue;
            const Bytes answer = answer_to(std::exchange(received, {}));
            if (!answer.empty()) pty_.write(answer);
        }
    }

    Bytes answer_to(const Bytes& request) {
        if (is_four_byte) return answer_in_four_bytes(request);
        if (request == sim::oven::sealed(frame({0x01, 0x03, 0x20, 0x00, 0x00, 0x05}))) {
            ++polls;
            std::this_thread::sleep_for(delay.load());
            return spoil(manner, frame({0x01, 0x03, 0x0A, 0x01, 0xA9, 0x01, 0x00, 0x01, 0xA9, 0x00,
                                        0x00, 0x00, 0xFA}));
        }
        if (request == sim::oven::sealed(frame({0x01, 0x03, 0x24, 0x10, 0x00, 0x01}))) {
            ++decimal_requests;
            Bytes answer = frame({0x01, 0x03, 0x02});
            sim::oven::append_word(answer, decimals);
            return spoil(decimals_manner, answer);
        }
        ++other_requests;
        return {};
    }

    Bytes answer_in_four_bytes(const Bytes& request) {
        if (request == sim::oven::sealed(frame({0x01, 0x03, 0x00, 0x00, 0x00, 0x0A}))) {
            ++polls;  // -1.5 degC, a set point of 42.5, 25.0 %
            return spoil(manner, frame({0x01, 0x03, 0x14, 0xFF, 0xFF, 0xFF, 0xF1, 0x00,
                                        0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0xA9, 0x00,
                                        0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xFA}));
        }
        if (request == sim::oven::sealed(frame({0x01, 0x03, 0x04, 0x20, 0x00, 0x02}))) {
            ++decimal_requests;
            Bytes answer = frame({0x01, 0x03, 0x04, 0x00, 0x00});
            sim::oven::append_word(answer, decimals);
            return spoil(decimals_manner, answer);
        }
        ++other_requests;
        return spoil(Manner::refused, {});
    }

    static Bytes spoil(Manner how, Bytes answer) {
        switch (how) {
            case Manner::good:
                break;
            case Manner::mute:
                return {};
            case Manner::half:
                answer.resize(answer.size() / 2);
                return answer;
            case Manner::bad_crc:
                answer = sim::oven::sealed(std::move(answer));
                answer.back() ^= std::byte{1};
                return answer;
            case Manner::refused:
                answer = frame({0x01, 0x83, 0x02});
                break;
            case Manner::other_unit:
                answer.front() = std::byte{2};
                break;
            case Manner::babble:
                return Bytes(64, std::byte{0x03});
            case Manner::own_babble:
                return Bytes(64, std::byte{0x01});
            case Manner::other_question:
                answer = frame({0x01, 0x03, 0x04, 0x01, 0xA9, 0x01, 0x00});
                break;
        }
        return sim::oven::sealed(std::move(answer));
    }

    static Bytes frame(std::initializer_list<int> values) {
        Bytes bytes;
        for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
        return bytes;
    }

    Pty pty_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace a351
