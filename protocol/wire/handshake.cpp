#include "protocol/wire/handshake.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

namespace a351::wire {
namespace {

using std::chrono::milliseconds;

constexpr int kTries = 3;
constexpr int kWrites = 2;  // the write and one retry

// A device just powered is ready after 0.9 s, one just reset after 0.97 s (data sheet table 2.2).
constexpr milliseconds kStartUpPoll{50};
constexpr milliseconds kStartUpLimit{3000};

// Setting a filter takes 4 ms for a built-in one, 100 ms for a user filter (data sheet table 2.2).
constexpr milliseconds kFilterPoll{5};
constexpr milliseconds kFilterLimit{500};

// A reset takes 0.97 s (data sheet table 2.2), that of the A370 1.17 s.
constexpr milliseconds kResetPause{1250};

constexpr milliseconds kModeChangePause{20};
constexpr DrainUntilSilent kShortDrain{.quiet = milliseconds(20), .limit = milliseconds(200)};

constexpr std::uint8_t kFirstIdentityAddress = 0x6A;  // PROD_ID1-4, VERSION, SERIAL_NUM1-4
constexpr std::size_t kIdentityRegisters = 9;
constexpr std::size_t kVersionIndex = 4;

std::string mismatch(const Register& reg, std::uint16_t expected, std::uint16_t found,
                     std::uint16_t mask) {
    return fmt::format("{}: expected 0x{:04X}, found 0x{:04X} (bits compared: 0x{:04X})", reg.name,
                       expected, found, mask);
}

void append_characters(std::uint16_t word, std::string& text) {
    text.push_back(static_cast<char>(word & 0xFF));  // the low byte is the first character
    text.push_back(static_cast<char>(word >> 8));
}

std::uint16_t rate_code(const DeviceProfile& profile, int output_rate_hz) {
    const auto found = std::ranges::find(profile.output_rates_hz, output_rate_hz, &Coded::value);
    if (found == profile.output_rates_hz.end()) {
        throw std::invalid_argument(fmt::format("Handshake: profile {} has no output rate of {} Hz",
                                                profile.name, output_rate_hz));
    }
    return static_cast<std::uint16_t>(found->code << 8U);
}

}  // namespace

Handshake::Handshake(const DeviceProfile& profile, SensorSettings settings,
                     std::string serial_number, StartUpTest last_test)
    : profile_(&profile),
      settings_(settings),
      expected_serial_number_(std::move(serial_number)),
      start_up_test_(last_test) {
    if (profile.filter_coded(settings.filter_code) == nullptr) {
        throw std::invalid_argument(
            fmt::format("Handshake: profile {} has no filter coded 0x{:04X}", profile.name,
                        settings.filter_code));
    }
    // TEMP_STABIL and MESMOD_SEL of SIG_CTRL stay as found.  So does the unused EXT_POL of
    // MSC_CTRL, because its high byte would start self tests.
    targets_ = {
        {&kSigCtrl, kSigNewDataEnables, kSigNewDataEnables | kSigTiltSelects},
        {&kMscCtrl, kMscDataReady, kMscExternalTrigger | kMscDataReady},
        {&kSmplCtrl, rate_code(profile, settings.output_rate_hz), kSmplCtrl.defined_bits},
        {&kFilterCtrl, settings.filter_code, kFilterSelect | kFilterBusy},
        {&kUartCtrl, kUartAuto, kUartAutoStart | kUartAuto},
        {&kBurstCtrl, settings.layout.burst_ctrl(), kBurstCtrl.defined_bits},
    };
    silence();
    queue_.push_back(Transmit{{kEndByte}});  // completes an interrupted command
    silence();
    ask(&Handshake::take_mode, kModeCtrl);
}

HandshakeStep Handshake::next(std::span<const std::byte> answer) {
    if (is_waiting_for_answer_) {
        is_waiting_for_answer_ = false;
        take_answer(answer);
    }
    assert(!queue_.empty());
    HandshakeStep step = queue_.front();
    if (std::holds_alternative<Sampling>(step) || std::holds_alternative<HandshakeFailure>(step))
        return step;
    queue_.pop_front();
    is_waiting_for_answer_ = std::holds_alternative<Receive>(step);
    return step;
}

void Handshake::silence() {
    send(stop_sampling());
    std::get<Transmit>(queue_.back()).pause_after = kModeChangePause;
    queue_.push_back(DrainUntilSilent{});
}

void Handshake::send(const CommandSequence& commands) {
    for (const Command& command : commands) {
        queue_.push_back(Transmit{{command.begin(), command.end()}, kCommandSpacing});
    }
}

void Handshake::wait(milliseconds time) {
    queue_.push_back(DrainUntilSilent{.quiet = time, .limit = time});
}

void Handshake::ask(Take take, const Register& reg) {
    take_ = take;
    asked_ = &reg;
    tries_left_ = take == nullptr && !reads_all_registers_ ? 1 : kTries;  // not every device has an ID
    queue_read();
}

void Handshake::queue_read() {
    send(config_ ? config_->read(*asked_) : read_mode());
    queue_.push_back(Receive{.byte_count = kAnswerSize});
}

void Handshake::retry(std::string reason) {
    if (--tries_left_ == 0) return fail(std::move(reason));
    ++repeated_reads_;
    queue_.push_back(Transmit{{kEndByte}});
    if (config_) {
        queue_.push_back(kShortDrain);
    } else {
        silence();
    }
    queue_read();
}

void Handshake::fail(std::string reason) {
    queue_.push_back(HandshakeFailure{std::move(reason), !has_answered_});
}

void Handshake::take_answer(std::span<const std::byte> answer) {
    const auto value = parse_answer(*asked_, answer);
    const bool is_required = take_ != nullptr;
    if (!value && (is_required || tries_left_ > 1)) {
        is_result_lost_ |= is_required && asked_ == &kDiagStat;
        return retry(fmt::format("{}: expected an answer of 4 bytes, found none in {} tries",
                                 asked_->name, kTries));
    }
    if (!is_required) {
        if (!value) queue_.push_back(kShortDrain);
        registers_.push_back({asked_, value});
        return ask_register();
    }
    has_answered_ = true;
    (this->*take_)(*value);
}

void Handshake::take_mode(std::uint16_t value) {
    config_ = ConfigMode::from_mode_ctrl(value);
    if (!config_) return retry(mismatch(kModeCtrl, kModeStatConfig, value, kModeStat));
    polls_left_ = static_cast<int>(kStartUpLimit / kStartUpPoll);
    ask(&Handshake::take_start_up, kGlobCmd);
}

void Handshake::take_start_up(std::uint16_t value) {
    if ((value & kGlobNotReady) == 0) {
        if (start_up_test_ != StartUpTest::passed && may_repeat_test_)
            return repeat_start_up_test();
        start_up_test_ = std::max(start_up_test_, StartUpTest::unknown);  // until it is answered
        return ask(&Handshake::take_diagnosis, kDiagStat);
    }
    if (--polls_left_ == 0) {
        return fail(fmt::format("{}: not ready after {} ms",
                                mismatch(kGlobCmd, 0, value, kGlobNotReady),
                                kStartUpLimit.count()));
    }
    wait(kStartUpPoll);
    ask(&Handshake::take_start_up, kGlobCmd);
}

/// Resets the device, and begins again with its mode: it may be set to sample after a start-up.
void Handshake::repeat_start_up_test() {
    may_repeat_test_ = is_result_lost_ = false;
    send(config_->write(kGlobCmd, kGlobSoftReset, kGlobSoftReset));
    config_.reset();
    wait(kResetPause);
    silence();
    ask(&Handshake::take_mode, kModeCtrl);
}

void Handshake::take_diagnosis(std::uint16_t value) {
    identity_.diag_stat = value;
    const StartUpTest found = start_up_test_in(value);
    start_up_test_ = is_result_lost_ ? std::max(start_up_test_, found) : found;
    if (start_up_test_ == StartUpTest::unknown && may_repeat_test_) return repeat_start_up_test();
    ask(&Handshake::take_identity, *register_at(Window::w1, kFirstIdentityAddress));
}

void Handshake::take_identity(std::uint16_t value) {
    if (identity_index_ < kVersionIndex) {
        append_characters(value, identity_.product_id);
    } else if (identity_index_ == kVersionIndex) {
        identity_.firmware = value;
    } else {
        append_characters(value, identity_.serial_number);
    }
    if (++identity_index_ < kIdentityRegisters) {
        const auto address = static_cast<std::uint8_t>(kFirstIdentityAddress + 2 * identity_index_);
        return ask(&Handshake::take_identity, *register_at(Window::w1, address));
    }
    identity_.has_expected_product_id =
        identity_.product_id.starts_with(profile_->product_id_prefix);
    if (!expected_serial_number_.empty() && identity_.serial_number != expected_serial_number_) {
        return fail(fmt::format("another instrument: serial number {}, expected {}",
                                identity_.serial_number, expected_serial_number_));
    }
    ask_register();
}

/// Asks for the next register whose answer is not required: ID, which Epson's other devices have, or
/// all.
void Handshake::ask_register() {
    const std::size_t next = registers_.size();
    if (reads_all_registers_ && next < kRegisters.size()) return ask(nullptr, kRegisters[next]);
    if (!reads_all_registers_ && next == 0) return ask(nullptr, kId);
    ask_target();
}

void Handshake::ask_target() {
    if (target_index_ == targets_.size()) return ask(&Handshake::take_aliasing, kFlag);
    writes_left_ = kWrites;
    polls_left_ = static_cast<int>(kFilterLimit / kFilterPoll);
    ask(&Handshake::take_configuration, *targets_[target_index_].reg);
}

void Handshake::take_configuration(std::uint16_t value) {
    const auto& [reg, wanted, mask] = targets_[target_index_];
    if (reg == &kFilterCtrl && (value & kFilterBusy) != 0 && --polls_left_ > 0) {
        wait(kFilterPoll);
        return ask(&Handshake::take_configuration, *reg);
    }
    if ((value & mask) == wanted) {
        ++target_index_;
        return ask_target();
    }
    if (writes_left_-- == 0) return fail(mismatch(*reg, wanted, value, mask));
    send(config_->write(*reg, static_cast<std::uint16_t>((value & ~mask) | wanted), mask));
    ask(&Handshake::take_configuration, *reg);
}

void Handshake::take_aliasing(std::uint16_t value) {
    if ((value & kFlagAliasing) != 0) {
        const FilterSpec* const filter = profile_->filter_coded(settings_.filter_code);
        return fail(fmt::format("{}: ALIASI_ERR, filter {} is not allowed at {} Hz",
                                mismatch(kFlag, 0, value, kFlagAliasing),
                                filter != nullptr ? filter->name : std::string_view(),
                                settings_.output_rate_hz));
    }
    ask(&Handshake::take_window, kWinCtrl);
}

void Handshake::take_window(std::uint16_t value) {
    if ((value & kWinCtrl.defined_bits) != 0)
        return retry(mismatch(kWinCtrl, 0, value, kWinCtrl.defined_bits));
    send(std::exchange(config_, std::nullopt).value().start_sampling().second);
    queue_.push_back(Sampling{identity_});
}

}  // namespace a351::wire
