#include "sim/line/fault_injector.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "protocol/core/input_error.hpp"

namespace a351::sim::line {
namespace {

using namespace std::chrono_literals;

/// Time without a frame after which no frame is expected to take a fault, simulated.
constexpr Nanoseconds kNoFrames = 1s;

constexpr auto kMostListed = static_cast<std::int64_t>(FaultReport::kMostListed);

/// Returns the code of a value, shifted to the high byte of its register.
std::uint16_t high_code(std::span<const wire::Coded> values, int value) {
    const auto found = std::ranges::find(values, value, &wire::Coded::value);
    return static_cast<std::uint16_t>(found->code << 8U);
}

/// Changes settings of a device and starts sampling, as if it had restarted with them.  The window
/// that the host selected and a partial command are kept.
void change_settings(device::RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now) {
    std::vector<device::RegisterChange> changes;
    if (fault.output_rate_hz > 0) {
        changes.push_back({wire::kSmplCtrl,
                           high_code(profile.output_rates_hz, fault.output_rate_hz),
                           wire::kHighByte});
    }
    if (!fault.filter.empty()) {
        changes.push_back(
            {wire::kFilterCtrl, profile.filter_named(fault.filter)->code, wire::kFilterSelect});
    }
    if (fault.burst_ctrl > 0) {
        changes.push_back({wire::kBurstCtrl, static_cast<std::uint16_t>(fault.burst_ctrl)});
    }
    if (fault.baud > 0) {
        changes.push_back(
            {wire::kUartCtrl, high_code(profile.baud_rates, fault.baud), wire::kHighByte});
    }
    machine.apply_settings(changes, now);
}

}  // namespace

FaultInjector::FaultInjector(const FaultScript& script, UtcTime start, Line& line,
                             device::RegisterMachine& machine, const wire::DeviceProfile& profile,
                             device::MachineIdentity identity, OvenHandler oven)
    : schedule_(script, start),
      answers_cut_frames_(script.answers_cut_frames),
      line_(line),
      machine_(machine),
      profile_(profile),
      identity_(std::move(identity)),
      oven_(std::move(oven)),
      places_(script.seed, "fault places"),
      last_frame_(start),
      muted_until_(start),
      overrun_until_(start),
      run_faults_(machine, profile, report_.by_kind) {}

/// Returns true if the device sends frames without being asked.
bool FaultInjector::sends_frames() const {
    return machine_.is_sampling() && (machine_.value_of(wire::kUartCtrl) & wire::kUartAuto) != 0;
}

void FaultInjector::send(std::span<const std::byte> bytes, UtcTime leaves,
                         const truth::Record* frame) {
    if (frame == nullptr) return send_answer(bytes, leaves);
    last_frame_ = leaves;
    truth::Record truth = *frame;
    run_faults_.follow(truth);
    apply_due(truth.utc, leaves);
    run_faults_.begin_with(truth);
    ++frames_made_;
    send_frame(bytes, leaves, truth);
}

void FaultInjector::send_answer(std::span<const std::byte> bytes, UtcTime leaves) {
    if (leaves < muted_until_) return;
    if (answers_cut_frames_ && sends_frames()) {
        held_answer_.insert(held_answer_.end(), bytes.begin(), bytes.end());
    } else {
        release_answer(leaves);
        line_.send(bytes, leaves, nullptr);
    }
}

/// Sends the held answers separately, because no frame comes that they could cut.
void FaultInjector::release_answer(UtcTime leaves) {
    if (held_answer_.empty()) return;
    if (leaves >= muted_until_) line_.send(held_answer_, leaves, nullptr);
    held_answer_.clear();
}

void FaultInjector::send_frame(std::span<const std::byte> bytes, UtcTime leaves,
                               truth::Record truth) {
    if (leaves < muted_until_) {
        count(FaultKind::silence);
        truth.fate = truth::Fate::lost;
        line_.send({}, leaves, &truth);
        return;
    }
    if (!held_answer_.empty()) {
        truth.fate = truth::Fate::damaged;
        line_.send(cut_by_answer(bytes, held_answer_, places_), leaves, &truth);
        held_answer_.clear();
        ++report_.frames_cut;
        return;
    }
    for (std::size_t i = 0; i < waiting_.size() && !held_frame_; ++i) {
        const Fault fault = waiting_[i].fault;
        if (fault.kind == FaultKind::bad_checksum && !has_right_checksum(bytes)) continue;
        if (--waiting_[i].frames == 0)
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
        count(fault.kind);
        return spoil(fault, bytes, leaves, truth);
    }
    line_.send(bytes, leaves, &truth);
    release_held(leaves);
}

void FaultInjector::spoil(const Fault& fault, std::span<const std::byte> bytes, UtcTime leaves,
                          truth::Record truth) {
    const auto send_damaged = [&](const Bytes& spoilt) {
        truth.fate = truth::Fate::damaged;
        line_.send(spoilt, leaves, &truth);
    };
    switch (fault.kind) {
        case FaultKind::flip_bit:
            return send_damaged(with_flipped_bits(bytes, fault.bits, places_));
        case FaultKind::bad_checksum:
            return send_damaged(with_bad_checksum(bytes, places_));
        case FaultKind::drop_bytes: {
            const Bytes rest = without_bytes(bytes, fault.bytes, places_);
            report_.bytes_dropped += static_cast<std::int64_t>(bytes.size() - rest.size());
            return send_damaged(rest);
        }
        case FaultKind::insert_bytes:
            report_.bytes_inserted += fault.bytes;
            return send_damaged(with_more_bytes(bytes, fault.bytes, places_));
        case FaultKind::truncate_frame: {
            const Bytes front = cut_short(bytes, places_);
            report_.bytes_dropped += static_cast<std::int64_t>(bytes.size() - front.size());
            return send_damaged(front);
        }
        case FaultKind::lose_frames:
            truth.fate = truth::Fate::lost;
            return line_.send({}, leaves, &truth);
        case FaultKind::garbage:
            report_.bytes_garbage += fault.bytes;
            line_.send_garbage(garbage_before(bytes, fault.bytes, places_), leaves);
            return line_.send(bytes, leaves, &truth);
        case FaultKind::duplicate_frame:
            line_.send(bytes, leaves, &truth);
            truth.fate = truth::Fate::repeated;
            return line_.send(bytes, leaves, &truth);
        case FaultKind::reorder_frames:
            held_frame_ = HeldFrame{Bytes(bytes.begin(), bytes.end()), truth};
            return;
        default:
            return line_.send(bytes, leaves, &truth);
    }
}

void FaultInjector::release_held(UtcTime leaves) {
    if (!held_frame_) return;
    held_frame_->truth.fate = truth::Fate::misplaced;
    line_.send(held_frame_->bytes, leaves, &held_frame_->truth);
    held_frame_.reset();
}

void FaultInjector::put_other_unit() {
    machine_.rename(identity_);
    machine_.power_cycle(steady_);
    is_unit_waiting_ = false;
}

/// Refuses a fault of frames, counter or flags if too many wait already.
void FaultInjector::require_room(const Fault& fault) const {
    const bool is_of_frame = fault.kind <= FaultKind::lose_frames;
    if ((is_of_frame ? waiting_.size() : run_faults_.waiting()) < kMostWaiting) return;
    throw InputError(fault.name + ": too many faults wait for a frame; allowed: " +
                     std::to_string(kMostWaiting));
}

void FaultInjector::apply(const Fault& fault, UtcTime simulated) {
    if (fault.kind <= FaultKind::error_flags) require_room(fault);
    if (fault.kind == FaultKind::oven && !(oven_ && oven_(fault.name, fault.count)))
        throw InputError(fault.name + ": no oven takes this fault; allowed: with --oven-link");
    if (++report_.applied_in_all <= kMostListed)
        report_.applied.push_back({fault.name, simulated, frames_made_});
    const UtcTime end = later_by(fault.seconds, simulated);
    if (fault.kind <= FaultKind::lose_frames) {  // Faults of frames come first.
        waiting_.push_back({fault, fault.count});
        return;
    }
    switch (fault.kind) {
        case FaultKind::counter_jump:
        case FaultKind::counter_stuck:
        case FaultKind::counter_reset:
        case FaultKind::error_flags:
            return run_faults_.add(fault);
        case FaultKind::silence:
            muted_until_ = std::max(muted_until_, end);
            return;
        case FaultKind::reset:
            machine_.spontaneous_reset(steady_);
            break;
        case FaultKind::power_cycle:
            machine_.power_cycle(steady_);
            break;
        case FaultKind::stop:
            machine_.fall_back_to_configuration();
            break;
        case FaultKind::other_unit:
            identity_.serial_number = fault.serial_number;
            is_unit_waiting_ = true;
            if (!fault.when_unplugged) put_other_unit();
            break;
        case FaultKind::change_settings:
        case FaultKind::change_baud:
            change_settings(machine_, profile_, fault, steady_);
            break;
        case FaultKind::failing_tests:
            machine_.fail_tests(static_cast<std::uint16_t>(fault.diag_stat));
            break;
        case FaultKind::stall:
            line_.hold_until(end);
            break;
        case FaultKind::hang_up:
            pull_out({end, fault.loses_power}, simulated);
            break;
        case FaultKind::overrun:
            overrun_until_ = fault.seconds > 0.0 ? std::max(overrun_until_, end) : UtcTime::max();
            break;
        default:
            break;
    }
    count(fault.kind);
}

void FaultInjector::apply_due(UtcTime now, UtcTime leaves) {
    while (const auto due = schedule_.take_due(now, frames_made_)) {
        try {
            apply(*due, leaves);
        } catch (const std::exception& error) {
            if (++report_.refused_in_all <= kMostListed)
                report_.refused.push_back({due->name, leaves, error.what()});
        }
    }
}

void FaultInjector::pull_out(const HangUp& asked, UtcTime simulated) {
    const HangUp before = hang_up_.value_or(asked);
    hang_up_ = HangUp{std::max(before.until, asked.until), before.loses_power || asked.loses_power};
    if (asked.loses_power) machine_.power_cycle(steady_);
    line_.unplug(simulated);
}

void FaultInjector::catch_up(const device::Instant& now) {
    const bool comes_nothing =
        !sends_frames() || (now.simulated - last_frame_ > kNoFrames && !line_.is_full());
    if (!comes_nothing) return;
    release_answer(now.simulated);
    if (held_frame_) {
        line_.send(held_frame_->bytes, now.simulated, &held_frame_->truth);
        held_frame_.reset();
    }
    apply_due(now.simulated, now.simulated);
}

std::optional<FaultInjector::HangUp> FaultInjector::take_hang_up() {
    return std::exchange(hang_up_, std::nullopt);
}

void FaultInjector::end_hang_up(const HangUp& hang_up, const device::Instant& now) {
    steady_ = now.steady;
    line_.plug_in();
    if (is_unit_waiting_) return put_other_unit();
    if (hang_up.loses_power) machine_.power_cycle(now.steady);
}

}  // namespace a351::sim::line
