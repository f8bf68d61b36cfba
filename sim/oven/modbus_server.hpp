#pragma once
/// @file
/// Modbus RTU between the line and the controller: framing, addressing, functions 03, 06, 08 and
/// 10h, timing, and the ways in which an answer can go wrong.  No I/O, no clock.

#include <array>
#include <cstdint>
#include <deque>

#include "protocol/core/utc_time.hpp"
#include "sim/oven/modbus_frame.hpp"
#include "sim/oven/oven_controller.hpp"

namespace a351::sim {

/// A fault of the answer to one request.  A request that meets `silence`, `babble` or `exception`
/// is not executed.
enum class OvenFault {
    silence,     ///< No answer.
    babble,      ///< 64 bytes of nonsense.
    exception,   ///< Exception 04.
    crc_error,   ///< One bit of the CRC is wrong.
    wrong_unit,  ///< Valid, but as if from the next unit.
    truncated,   ///< The first half only.
    delay        ///< Right, but ServerOptions::fault_delay too late.
};
inline constexpr std::size_t kOvenFaultCount = 7;

struct ServerOptions {
    int unit = 1;  ///< 1 ... 99.
    int baud = 9600;
    Nanoseconds answer_wait = std::chrono::milliseconds(20);  ///< "Send data wait time", factory.
    Nanoseconds restart_time = std::chrono::seconds(5);       ///< E5EK manual, section 6.4.
    Nanoseconds fault_delay = std::chrono::seconds(1);
};

/// What became of what was received.  Every request and every stray run of bytes, which silence
/// ends, is in just one of these once it is over; an answer is when it leaves.
struct OvenReport {
    std::int64_t answers = 0;          ///< As they should be, exceptions included.
    std::int64_t exceptions = 0;       ///< Of the answers: refused by the controller.
    std::int64_t answers_lost = 0;     ///< Nobody at the other end, or switched off meanwhile.
    std::int64_t resets = 0;           ///< Software resets, which are never answered.
    std::int64_t broadcasts = 0;       ///< Executed if possible, never answered.
    std::int64_t for_other_units = 0;  ///< Valid, not for this unit.
    std::int64_t unreadable = 0;       ///< Noise, bad CRC, or 3.5 characters of silence within.
    std::int64_t unheard = 0;          ///< While an answer was due, in a restart, or not on Modbus.
    std::array<std::int64_t, kOvenFaultCount> faults{};  ///< Answers spoilt, by kind.
};

/// Serves one controller.  Times are those of the host's steady clock, since masters wait in real
/// time; characters take 11 bits (8 data bits with parity, or two stop bits).
///
/// A request ends where its own length says; one of an unknown function, with 3.5 characters of
/// silence.  After bytes that make no sense, or come when nothing is heard, everything is ignored
/// until there is such a silence.
/// The answer is given whole when its last character would have arrived: request and answer take
/// their time on the line, and between them lies the wait.  Half duplex: until then what arrives is
/// not heard.
class ModbusServer {
public:
    ModbusServer(OvenController& controller, const ServerOptions& options);

    void receive(std::span<const std::byte> bytes, Nanoseconds now);

    /// Characters that cannot be made out, as from a master at another speed.
    void receive_noise(Nanoseconds now);

    /// What leaves for the master by now.
    /// @param is_heard  false: there is no master at the other end, and an answer is lost.
    [[nodiscard]] std::vector<std::byte> advance_to(Nanoseconds now, bool is_heard = true);

    /// When advance_to() has something to do again, if nothing is received before.
    [[nodiscard]] std::optional<Nanoseconds> next_due() const;

    /// Spoils the next `count` answers, or all until further notice if -1; 0 ends it.  Of
    /// several kinds at a time the first in the order of OvenFault takes its turn.
    void fail_next(OvenFault kind, int count);

    /// Power off and on.
    void restart(Nanoseconds now);

    [[nodiscard]] const OvenReport& report() const noexcept { return report_; }

private:
    struct Answer {
        Nanoseconds due{0};
        std::vector<std::byte> bytes;
        std::optional<OvenFault> fault;
        bool is_exception = false;
    };

    [[nodiscard]] Nanoseconds characters(double count) const;
    void end_by_silence(Nanoseconds now);
    void ignore_run(std::int64_t& counter);
    void forget_answer();
    void take_requests(Nanoseconds now);
    void handle(std::span<const std::byte> request, Nanoseconds now);
    [[nodiscard]] std::vector<std::byte> answer_to(std::span<const std::byte> request,
                                                   Nanoseconds now);
    [[nodiscard]] std::optional<OvenFault> next_fault() const;
    void spend(OvenFault fault);
    void reply(Answer answer, std::size_t request_size, Nanoseconds now);

    OvenController& controller_;
    ServerOptions options_;
    Nanoseconds silence_;  ///< What ends a frame.
    std::vector<std::byte> received_;
    Nanoseconds last_byte_{0};
    bool is_ignoring_ = false;  ///< The rest of a run that is counted.
    std::optional<Answer> answer_;
    Nanoseconds restarted_at_{0};
    bool is_restarting_ = false;
    std::array<int, kOvenFaultCount> remaining_{};
    OvenReport report_;
};

}  // namespace a351::sim
