#pragma once
/// @file
/// A device with only the parts that the handshake needs: registers, modes, and faults on demand.

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <variant>

#include "protocol/wire/handshake.hpp"
#include "tests/unit/wire/burst_stream.hpp"

namespace a351::wire {

class ScriptedRegisters {
public:
    using Key = std::pair<Window, std::uint8_t>;

    bool is_sampling = false;
    bool samples_after_reset = false;     ///< AUTO_START.
    int not_ready_reads = 0;              ///< Number of reads for which GLOB_CMD reports NOT_READY.
    int filter_busy_reads = 0;            ///< Number of reads with FILTER_STAT busy after a write.
    std::map<Key, int> unanswered;        ///< Number of reads that get no answer, by register.
    std::map<Key, int> lost_writes;       ///< Number of writes that have no effect, by register.
    std::map<Key, std::uint16_t> forced;  ///< Value that reads always return, by register.
    std::uint16_t start_up_faults = 0;    ///< Bits of DIAG_STAT that each start-up raises.
    int resets = 0;                       ///< Number of soft resets.
    Bytes half_sent;                      ///< Command that a former host left unfinished.
    std::vector<Bytes> received;          ///< Received commands, including window selections.

    ScriptedRegisters() {
        for (const Register& reg : kRegisters) {
            values[{reg.window, reg.address}] = reg.default_value;
        }
    }

    std::map<Key, std::uint16_t> values;

    void set(const Register& reg, std::uint16_t value) { values[key(reg)] = value; }
    [[nodiscard]] std::uint16_t get(const Register& reg) const { return values.at(key(reg)); }
    [[nodiscard]] static Key key(const Register& reg) { return {reg.window, reg.address}; }

    /// Bytes on their way to the host.
    Bytes output;

    void take(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) {
            half_sent.push_back(byte);
            if (half_sent.front() == kEndByte) half_sent.clear();
            if (half_sent.size() < 3) continue;
            if (half_sent[2] == kEndByte) {
                received.push_back(half_sent);
                obey(std::to_integer<std::uint8_t>(half_sent[0]),
                     std::to_integer<std::uint8_t>(half_sent[1]));
                half_sent.clear();
            } else {
                half_sent.erase(half_sent.begin());
            }
        }
    }

private:
    void obey(std::uint8_t first, std::uint8_t value) {
        if (first == 0xFE) {
            window_ = static_cast<Window>(value);
        } else if ((first & 0x80) != 0) {
            write(first & 0x7F, value);
        } else {
            read(first);
        }
    }

    void write(int address, std::uint8_t value) {
        const Key where{window_, static_cast<std::uint8_t>(address & 0x7E)};
        if (where == key(kModeCtrl)) {
            is_sampling = value == 1;
            values[where] = is_sampling ? 0x0000 : 0x0400;
            return;
        }
        if (is_sampling || lost_writes[where]-- > 0) return;
        if (where == key(kGlobCmd) && value == kGlobSoftReset) {
            ++resets;
            values[key(kDiagStat)] = start_up_faults;
            is_sampling = samples_after_reset;
            return;
        }
        const auto old = values[where];
        values[where] = static_cast<std::uint16_t>(address % 2 == 1 ? (old & 0x00FF) | (value << 8)
                                                                    : (old & 0xFF00) | value);
        if (where == key(kFilterCtrl)) busy_reads_left_ = filter_busy_reads;
    }

    void read(std::uint8_t address) {
        const Key where{window_, address};
        if (unanswered[where]-- > 0) {
            if (where == key(kDiagStat)) values[where] = 0;
            return;
        }
        std::uint16_t value = values[where];
        if (address == kWinCtrl.address) value = static_cast<std::uint16_t>(window_);
        if (where == key(kGlobCmd) && not_ready_reads-- > 0) value |= kGlobNotReady;
        if (where == key(kFilterCtrl) && busy_reads_left_-- > 0) value |= kFilterBusy;
        if (forced.contains(where)) value = forced.at(where);
        output.push_back(static_cast<std::byte>(address));
        output.push_back(static_cast<std::byte>(value >> 8));
        output.push_back(static_cast<std::byte>(value & 0xFF));
        output.push_back(kEndByte);
        if (where == key(kDiagStat)) values[where] = 0;
    }

    Window window_ = Window::w1;  ///< Window that a former host selected.
    int busy_reads_left_ = 0;
};

/// Result of a handshake, as seen by its driver.
struct HandshakeRun {
    HandshakeStep end;
    std::chrono::milliseconds waited{0};  ///< Sum of pauses and quiet times; answers take no time.

    [[nodiscard]] bool has_succeeded() const { return std::holds_alternative<Sampling>(end); }
    [[nodiscard]] const DeviceIdentity& identity() const {
        return std::get<Sampling>(end).identity;
    }
    [[nodiscard]] const std::string& reason() const {
        return std::get<HandshakeFailure>(end).reason;
    }
};

inline HandshakeRun run_handshake(Handshake& handshake, ScriptedRegisters& device) {
    HandshakeRun run;
    Bytes answer;
    for (int steps = 0; steps < 5000; ++steps) {
        run.end = handshake.next(answer);
        answer.clear();
        if (device.is_sampling) {  // frames keep coming until the device is stopped
            append_frame(BurstLayout::recommended(), BurstValues{}, device.output);
        }
        if (const auto* transmit = std::get_if<Transmit>(&run.end)) {
            device.take(transmit->bytes);
            run.waited += transmit->pause_after;
        } else if (const auto* receive = std::get_if<Receive>(&run.end)) {
            const auto count = std::min(receive->byte_count, device.output.size());
            const auto end = device.output.begin() + static_cast<std::ptrdiff_t>(count);
            answer.assign(device.output.begin(), end);
            device.output.erase(device.output.begin(), end);
            if (count < receive->byte_count) run.waited += receive->timeout;
        } else if (const auto* drain = std::get_if<DrainUntilSilent>(&run.end)) {
            device.output.clear();
            run.waited += drain->quiet;
        } else {
            break;
        }
    }
    return run;
}

}  // namespace a351::wire
