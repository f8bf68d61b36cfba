#pragma once
/// @file
/// Modbus RTU between the line and the controller: framing, addressing, functions 03, 06, 08 and
/// 10h, timing, and faults of answers.  No I/O, no clock.

#include <array>
#include <cstdint>

#include "protocol/core/utc_time.hpp"
#include "sim/oven/modbus_frame.hpp"
#include "sim/oven/oven_controller.hpp"

namespace a351::sim::oven {

/// A fault of the answer to one request.  With `silence`, `babble` or `exception` the request is
/// not executed.
enum class Fault {
    silence,     ///< No answer.
    babble,      ///< 64 bytes of nonsense.
    exception,   ///< Exception 04.
    crc_error,   ///< One bit of the CRC is wrong.
    wrong_unit,  ///< Valid, but with the next unit's number.
    truncated,   ///< Only the first half.
    delay        ///< Correct, but 1 s late.
};
inline constexpr std::size_t kOvenFaultCount = 7;

/// Counts of the received requests.  Every request, and every run of stray bytes up to a silence,
/// is counted exactly once when it is over; an answer is counted when it leaves.
struct Report {
    std::int64_t answers = 0;          ///< Correct answers, including exceptions.
    std::int64_t exceptions = 0;       ///< Part of the answers: refused by the controller.
    std::int64_t answers_lost = 0;     ///< No master at the other end, or power off before.
    std::int64_t resets = 0;           ///< Software resets, which are never answered.
    std::int64_t broadcasts = 0;       ///< Executed if possible, never answered.
    std::int64_t for_other_units = 0;  ///< Valid, not for this unit.
    std::int64_t unreadable = 0;       ///< Noise, bad CRC, or a silence of 3.5 characters inside.
    std::int64_t ignored = 0;          ///< Ignored: answer due, restart, or not on Modbus.
    std::array<std::int64_t, kOvenFaultCount> faults{};  ///< Answers with a fault, by kind.
};

/// Serves one controller.  Times are on the host's steady clock, because masters wait in real time.
/// The unit has number 1.  A character has 11 bits (8 data bits with parity, or two stop bits).
///
/// A request ends at its own length; a request of an unknown function ends with a silence of 3.5
/// characters.  After bytes that are not a request, or that come while the server does not listen,
/// everything is ignored up to the next such silence.
/// The whole answer is handed over when its last character would have arrived: after the request's
/// time on the line, the wait, and the answer's time on the line.  The line is half duplex: bytes
/// that arrive before are ignored.
class ModbusServer {
public:
    static constexpr int kBaud = 9600;  ///< Factory setting.

    explicit ModbusServer(Controller& controller) : controller_(controller) {}

    void receive(std::span<const std::byte> bytes, Nanoseconds now);

    /// Takes unreadable characters, such as from a master with another baud rate.
    void receive_noise(Nanoseconds now);

    /// Returns the bytes that are due for the master by now.
    /// @param has_master  false: no master is at the other end, and an answer is lost.
    [[nodiscard]] std::vector<std::byte> advance_to(Nanoseconds now, bool has_master = true);

    /// Returns when advance_to() has something to do, if nothing is received before.
    [[nodiscard]] std::optional<Nanoseconds> next_due() const;

    /// Gives the next `count` answers this fault; -1: all answers from now on; 0: none any more.
    /// If several kinds are active, the first in the order of Fault is applied.
    void fail_next(Fault kind, int count) { remaining_[static_cast<std::size_t>(kind)] = count; }

    /// Switches the power off and on.
    void restart(Nanoseconds now);

    [[nodiscard]] const Report& report() const noexcept { return report_; }

private:
    struct Answer {
        Nanoseconds due{0};
        std::vector<std::byte> bytes;
        std::optional<Fault> fault;
        bool is_exception = false;
    };

    void end_by_silence(Nanoseconds now);
    void ignore_run(std::int64_t& counter);
    void forget_answer();
    void take_requests(Nanoseconds now);
    void handle(std::span<const std::byte> request, Nanoseconds now);
    [[nodiscard]] std::vector<std::byte> answer_to(std::span<const std::byte> request,
                                                   Nanoseconds now);
    [[nodiscard]] std::optional<Fault> next_fault() const;
    void spend(Fault fault);
    void reply(Answer answer, std::size_t request_size, Nanoseconds now);

    Controller& controller_;
    std::vector<std::byte> received_;
    Nanoseconds last_byte_{0};
    bool is_ignoring_ = false;  ///< Ignores the rest of a run already counted.
    std::optional<Answer> answer_;
    Nanoseconds restarted_at_{0};
    bool is_restarting_ = false;
    std::array<int, kOvenFaultCount> remaining_{};
    Report report_;
};

}  // namespace a351::sim::oven
