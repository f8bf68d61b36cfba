#pragma once
/// @file
/// Brings the sensor from any state into sampling, as a state machine without I/O: it returns the
/// next step, a driver carries it out and passes back the answer of the device.  Sequence:
/// M-A352AD10 data sheet 8.2.  Every setting written is read back and compared, under a mask of the
/// bits that sampling depends on.
///
/// The driver needs a port at the right baud rate and a way to wait:
///
///     Handshake handshake(profile, settings);
///     std::vector<std::byte> answer;
///     for (;;) {
///         HandshakeStep step = handshake.next(answer);
///         answer.clear();
///         if (const auto* transmit = std::get_if<Transmit>(&step)) {
///             write(transmit->bytes);
///             sleep(transmit->pause_after);
///         } else if (const auto* receive = std::get_if<Receive>(&step)) {
///             answer = read_at_most(receive->byte_count, receive->timeout);
///         } else if (const auto* drain = std::get_if<DrainUntilSilent>(&step)) {
///             discard_until_silent(drain->quiet, drain->limit);
///         } else {
///             return step;  // Sampling or HandshakeFailure.
///         }
///     }
///
/// No clock is read here: the steps depend only on the arguments and the answers.  The device is
/// given longer than it may need by its data sheet: 3 s instead of 0.97 s for start-up, 0.5 s
/// instead of 0.1 s for a filter.  A silent line fails within 1 s (handshake_test.cpp); one that
/// never becomes silent costs up to 2 s per DrainUntilSilent.
///
/// Do not use it for a stream that must continue without a gap, because the first step stops the
/// device.

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
#include "protocol/wire/start_up_test.hpp"

namespace a351::wire {

/// Settings that the device gets.  The defaults fit each other.
///
/// Rate and filter must fit: DeviceProfile::filters_allowed_at().  Only the device checks the pair;
/// an illegal one ends in a HandshakeFailure that names ALIASI_ERR.  The baud rate must carry the
/// frames: BurstLayout::frame_size().
struct SensorSettings {
    /// Output rate, samples/s: one of DeviceProfile::output_rates_hz.
    int output_rate_hz = 50;
    std::uint8_t filter_code = 6;  ///< k512_fc9, the only built-in filter allowed at 50 Hz.
    /// Fields of each frame; give the same layout to BurstDecoder.
    BurstLayout layout = BurstLayout::recommended();
};

/// Identity and state that the device reported during the handshake.
///
/// Both texts can hold any byte, because a faulty line or device may send any: escape them before
/// they are shown.
struct DeviceIdentity {
    std::string product_id;                ///< Eight characters, as read.
    std::string serial_number;             ///< Eight characters, as read.
    std::uint16_t firmware = 0;            ///< VERSION.
    std::uint16_t diag_stat = 0;           ///< DIAG_STAT before configuration; reading clears it.
    bool has_expected_product_id = false;  ///< True if it starts with the profile's prefix.
};

/// Value of a register as read; absent if the device did not answer.
struct RegisterValue {
    const Register* reg = nullptr;
    std::optional<std::uint16_t> value;
};

// Steps that the driver has to carry out.  Times are real time.

/// Send these bytes: one command, or a lone CR.  Then wait for `pause_after` and ask for the next
/// step with an empty answer.
struct Transmit {
    std::vector<std::byte> bytes;
    std::chrono::milliseconds pause_after{1};  ///< The device needs 0.2-0.66 ms between commands.
};
/// Read up to `byte_count` bytes; give up after `timeout`.  Pass what was received to next(), even
/// if it is nothing.
struct Receive {
    std::size_t byte_count = 0;
    std::chrono::milliseconds timeout{100};
};
/// With `quiet` equal to `limit` it is a pause.  Pass an empty answer to next() afterwards.
struct DrainUntilSilent {  ///< Discard input until none came for `quiet`, but not beyond `limit`.
    std::chrono::milliseconds quiet{50};
    std::chrono::milliseconds limit{2000};
};
/// Last step of success.  The start command was sent; there is no answer to it.  The first frame
/// comes when the filter is filled: 0.14 s of silence at 50 Hz with 512 taps (table 5.3).  If no
/// frame comes within some seconds, begin again with a new Handshake.
struct Sampling {  ///< Done: frames follow.
    DeviceIdentity identity;
};
/// Last step of a failure.  No start command was sent; some settings may have been written.  Begin
/// again with a new Handshake, after a pause.  If `is_unanswered`, the cable, the power or the baud
/// rate may be wrong: try another baud rate.
struct HandshakeFailure {
    std::string reason;          ///< One line: register, expected and found value.
    bool is_unanswered = false;  ///< True if no valid answer came at all.
};
/// One step; exactly one alternative.
using HandshakeStep = std::variant<Transmit, Receive, DrainUntilSilent, Sampling, HandshakeFailure>;

/// Sequence: stop and drain twice, check configuration mode, wait for start-up, read diagnosis,
/// read identity, set registers (only those that differ are written), check rate against filter,
/// check window, start.  A read without a valid answer is repeated.  Flash is never written and the
/// baud rate is never changed.
///
/// A read is tried three times, a setting is written twice at most; then the handshake fails and
/// names the register.  It recovers from a device that is sampling and from a command that another
/// program left half sent.
///
/// These are set: new-data bits, acceleration instead of tilt, internal timer, pin DRDY on and
/// active high, rate, filter, UART_AUTO without AUTO_START, and the layout.  Thermal stabilisation
/// and noise mode are left as found.  Offsets, alarm limits and long-term filter are neither read
/// nor changed.  Nothing is saved: a reset or loss of power restores the settings in the flash.
///
/// The result of the start-up test is only reported (start_up_test()), as another product identifier
/// is.  If it is not known to be passed, the handshake begins with a reset (SOFT_RST), which repeats
/// the test: when the last one failed, or when the answer with its result was lost.  The reset
/// restores the settings in the flash.
///
/// An object is for one attempt and for one thread at a time.
class Handshake {
public:
    /// Prepares the steps; nothing is sent before next() is called and its steps are carried out.
    /// @param profile        must outlive this object.
    /// @param settings       copied; the layout is valid by its type.
    /// @param serial_number  only this instrument is configured; empty: any.  Another one has then
    ///                       been stopped and its DIAG_STAT read, but no setting is changed.
    /// @param last_test      result of the last start-up test known of this sensor.
    /// @throws std::invalid_argument  the profile lacks the rate or the filter.
    Handshake(const DeviceProfile& profile, SensorSettings settings, std::string serial_number = {},
              StartUpTest last_test = StartUpTest::passed);

    /// Returns the result of the start-up test, as far as it is known now; `last_test` before
    /// DIAG_STAT is read.  It is also valid if the handshake failed or was not completed.
    [[nodiscard]] StartUpTest start_up_test() const noexcept { return start_up_test_; }

    /// Makes the handshake also read each of kRegisters, before it writes a setting.  A register that
    /// does not answer in three tries is no failure.  Call it before next().
    void read_all_registers() noexcept { reads_all_registers_ = true; }

    /// Return what was read so far, also after a failure.
    [[nodiscard]] const DeviceIdentity& identity() const noexcept { return identity_; }
    [[nodiscard]] const std::vector<RegisterValue>& registers() const noexcept {
        return registers_;
    }

    /// Returns how many reads were repeated because an answer was late, lost or wrong.
    [[nodiscard]] int repeated_reads() const noexcept { return repeated_reads_; }

    /// Returns the next step.  After Sampling or HandshakeFailure it returns the same step again.
    ///
    /// Call it once per step that was carried out.  The bytes are not kept after the call.  Bytes
    /// beyond those requested make an answer invalid; leave them in the port.
    ///
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
    void repeat_start_up_test();
    void take_diagnosis(std::uint16_t value);
    void take_identity(std::uint16_t value);
    void take_configuration(std::uint16_t value);
    void take_aliasing(std::uint16_t value);
    void take_window(std::uint16_t value);
    void ask_register();
    void ask_target();

    const DeviceProfile* profile_;
    SensorSettings settings_;
    std::string expected_serial_number_;
    StartUpTest start_up_test_;
    bool may_repeat_test_ = true;
    bool is_result_lost_ = false;  ///< An answer with the result of the start-up test was lost.
    std::vector<Target> targets_;
    std::deque<HandshakeStep> queue_;
    Take take_ = nullptr;  ///< Null: the answer is not required.
    const Register* asked_ = &kModeCtrl;
    bool is_waiting_for_answer_ = false;
    bool has_answered_ = false;
    int tries_left_ = 0;
    int repeated_reads_ = 0;
    int polls_left_ = 0;
    int writes_left_ = 0;
    std::size_t identity_index_ = 0;
    std::size_t target_index_ = 0;
    std::optional<ConfigMode> config_;
    DeviceIdentity identity_;
    bool reads_all_registers_ = false;
    std::vector<RegisterValue> registers_;
};

}  // namespace a351::wire
