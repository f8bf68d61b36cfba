#pragma once
/// @file
/// Brings the sensor from any state into sampling, as a state machine without I/O: it returns the
/// next step, a driver carries it out and passes back the answer of the device.  Sequence and
/// time-outs: M-A352AD10 data sheet 8.2.  Every register written is read back and compared under a
/// mask of its defined bits.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/wire/burst_frame.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::wire {

struct SensorSettings {
    int output_rate_hz = 50;
    std::uint8_t filter_code = 6;  ///< k512_fc9, the only built-in filter allowed at 50 Hz.
    BurstLayout layout = BurstLayout::recommended();
};

struct DeviceIdentity {
    std::string product_id;                ///< Eight characters, as read.
    std::string serial_number;             ///< Eight characters, as read.
    std::uint16_t firmware = 0;            ///< VERSION.
    std::uint16_t diag_stat = 0;           ///< DIAG_STAT before configuration; reading clears it.
    bool has_expected_product_id = false;  ///< True if it starts with the profile's prefix.
};

// Steps that the driver has to carry out.  Times are real time.

struct Transmit {
    std::vector<std::byte> bytes;
    std::chrono::milliseconds pause_after{1};  ///< The device needs 0.2-0.66 ms between commands.
};
struct Receive {
    std::size_t byte_count = 0;
    std::chrono::milliseconds timeout{100};
};
struct DrainUntilSilent {  ///< Discard input until none came for `quiet`, but not beyond `limit`.
    std::chrono::milliseconds quiet{50};
    std::chrono::milliseconds limit{2000};
};
struct Sampling {  ///< Done: frames follow.
    DeviceIdentity identity;
};
struct HandshakeFailure {
    std::string reason;          ///< One line: register, expected and found value.
    bool is_unanswered = false;  ///< True if no valid answer came at all.
};
using HandshakeStep = std::variant<Transmit, Receive, DrainUntilSilent, Sampling, HandshakeFailure>;

/// Sequence: stop and drain twice, check configuration mode, wait for start-up, check diagnosis,
/// read identity, set registers (only those that differ are written), check rate against filter,
/// check window, start.  A read without a valid answer is repeated.  Flash is never written and the
/// baud rate is never changed.
class Handshake {
public:
    /// @param profile        must outlive this object.
    /// @param serial_number  only this instrument is configured; empty: any.
    /// @throws std::invalid_argument  the profile lacks the rate or the filter.
    Handshake(const DeviceProfile& profile, SensorSettings settings,
              std::string serial_number = {});

    /// Returns the next step.  After Sampling or HandshakeFailure it returns the same step again.
    /// @param answer  bytes received for the last Receive, fewer than requested after a time-out;
    ///                empty for every other step.
    [[nodiscard]] HandshakeStep next(std::span<const std::byte> answer);

private:
    /// Takes the value of the register that was asked for.
    using Take = void (Handshake::*)(std::uint16_t value);

    /// Bits of a register that sampling depends on.
    struct Target {
        const Register* reg;
        std::uint16_t wanted;
        std::uint16_t mask;
    };

    void silence();
    void send(const CommandSequence& commands);
    void wait(std::chrono::milliseconds time);
    void ask(Take take, const Register& reg);
    void queue_read();
    void retry(std::string reason);
    void fail(std::string reason);

    void take_answer(std::span<const std::byte> answer);
    void take_mode(std::uint16_t value);
    void take_start_up(std::uint16_t value);
    void take_diagnosis(std::uint16_t value);
    void take_identity(std::uint16_t value);
    void take_configuration(std::uint16_t value);
    void take_aliasing(std::uint16_t value);
    void take_window(std::uint16_t value);
    void ask_target();

    const DeviceProfile* profile_;
    SensorSettings settings_;
    std::string expected_serial_number_;
    std::vector<Target> targets_;
    std::deque<HandshakeStep> queue_;
    Take take_ = nullptr;
    const Register* asked_ = &kModeCtrl;
    bool is_waiting_for_answer_ = false;
    bool has_answered_ = false;
    int tries_left_ = 0;
    int polls_left_ = 0;
    int writes_left_ = 0;
    std::size_t identity_index_ = 0;
    std::size_t target_index_ = 0;
    std::optional<ConfigMode> config_;
    DeviceIdentity identity_;
};

}  // namespace a351::wire
