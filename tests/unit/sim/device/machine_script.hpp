#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/device/device_stream.hpp"
#include "sim/device/register_machine.hpp"

namespace a351::sim::device {

/// Returns the bytes of a text in hex: "FE 01 0D" are three bytes.
inline std::vector<std::byte> bytes_of(std::string_view hex) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i + 1 < hex.size();) {
        if (hex[i] == ' ') {
            ++i;
            continue;
        }
        bytes.push_back(
            static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
        i += 2;
    }
    return bytes;
}

inline std::string hex_of(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string hex;
    for (const std::byte byte : bytes) {
        if (!hex.empty()) hex += ' ';
        hex += kDigits[std::to_integer<std::size_t>(byte >> 4)];
        hex += kDigits[std::to_integer<std::size_t>(byte & std::byte{0x0F})];
    }
    return hex;
}

/// Sample of a real A352, from a register dump that the maker published.
inline constexpr signal::SensorSample kSample{{-203896, 604794, 16713252}, 2466};

inline constexpr std::int32_t kOneG = 1 << 24;

/// A machine with a clock that the test moves.
struct Bench {
    explicit Bench(std::string_view profile = "A352AD10",
                   MachineIdentity identity = {"A352AD10", "01234567", 0x000D},
                   const FlashMemory& flash = {})
        : machine(*wire::find_profile(profile), std::move(identity), Nanoseconds(0), flash) {
        now = power_on_time(*wire::find_profile(profile));
        machine.pass_time(now);
    }

    /// Sends whole commands, given as their first two bytes; returns the answers as hex.
    std::string send(std::initializer_list<std::string_view> commands) {
        return send(std::vector(commands));
    }
    std::string send(const std::vector<std::string_view>& commands) {
        std::vector<std::byte> answers;
        for (const std::string_view command : commands) {
            machine.receive(bytes_of(std::string(command) + " 0D"), now, answers);
            now += std::chrono::milliseconds(1);
        }
        return hex_of(answers);
    }

    /// Returns the four hex digits of a register, "none" without an answer.  The place is written
    /// as in the data sheet, for example "W0:4C".
    std::string read(std::string_view place) {
        const std::string window = place[1] == '0' ? "FE 00" : "FE 01";
        const std::string answer = send({window, std::string(place.substr(3)) + " 00"});
        return answer.size() < 8 ? "none" : answer.substr(3, 2) + answer.substr(6, 2);
    }

    /// Writes a byte to a register: "W1:85 06" sends the command 85 06 in window 1.
    void write(std::string_view place) {
        send({place[1] == '0' ? "FE 00" : "FE 01", place.substr(3)});
    }

    void wait(Nanoseconds time) {
        now += time;
        machine.pass_time(now);
    }

    void power_cycle() {
        machine.power_cycle(now);
        wait(power_on_time(*wire::find_profile("A352AD10")));
    }
    void reset() {
        machine.spontaneous_reset(now);
        wait(RegisterMachine::kResetTime);
    }

    /// Gives the machine `count` equal samples; returns the frames as hex.
    std::string sample(int count = 1, const signal::SensorSample& values = kSample) {
        std::vector<std::byte> frames;
        for (int i = 0; i < count; ++i) static_cast<void>(machine.sample(values, frames));
        return hex_of(frames);
    }

    /// Starts sampling as the recorder does: 50 Hz, 512 taps at 9 Hz, automatic frames, all fields.
    void start_logging() {
        send({"FE 01", "85 06", "86 06", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    }

    /// Samples without a frame after start_logging(): the transient of the filter.
    static constexpr int kTransient = 7;

    RegisterMachine machine;
    Nanoseconds now{0};
};

/// Samples at a rate from time 0; `values` gives those of the n-th.
class GridSource final : public signal::SampleSource {
public:
    using Values = std::function<signal::SensorSample(std::int64_t)>;

    GridSource(int rate_hz, Values values) : rate_hz_(rate_hz), values_(std::move(values)) {}
    [[nodiscard]] int rate_hz() const noexcept override { return rate_hz_; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override {
        return UtcTime(index_ * Nanoseconds(std::chrono::seconds(1)) / rate_hz_);
    }
    [[nodiscard]] signal::TimedSample next() override {
        const signal::TimedSample sample{*next_instant(), index_, values_(index_)};
        ++index_;
        return sample;
    }

private:
    int rate_hz_;
    Values values_;
    std::int64_t index_ = 0;
};

/// Everything the device sends.
struct Collected final : LineSink {
    void send(std::span<const std::byte> sent, UtcTime leaves,
              const truth::Record* frame) override {
        bytes.insert(bytes.end(), sent.begin(), sent.end());
        if (frame == nullptr) return;
        truth.push_back(*frame);
        times.push_back(leaves);
    }
    [[nodiscard]] bool is_full() const override { return false; }

    std::vector<std::byte> bytes;
    std::vector<truth::Record> truth;
    std::vector<UtcTime> times;
};

}  // namespace a351::sim::device
