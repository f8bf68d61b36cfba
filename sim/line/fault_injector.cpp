#include "sim/line/fault_injector.hpp"

#include <chrono>
#include <utility>

#include "protocol/core/input_error.hpp"
#include "sim/line/device_faults.hpp"

namespace a351::sim {
namespace {

using namespace std::chrono_literals;

/// Without a frame for so long, none is on its way to take a fault.
constexpr Nanoseconds kNoFrames = 1s;
constexpr unsigned kHalfRange = 0x8000;

}  // namespace

FaultInjector::FaultInjector(const FaultScript& script, UtcTime start, Line& line,
                             RegisterMachine& machine, const wire::DeviceProfile& profile,
                             MachineIdentity identity, OvenHandler oven)
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
      overrun_until_(start) {}

std::uint16_t FaultInjector::count_step() const {
    return profile_.count_step(machine_.output_rate_hz());
}

void FaultInjector::send(std::span<const std::byte> bytes, UtcTime leaves,
                         const TruthRecord* frame) {
    if (frame == nullptr) return send_answer(bytes, leaves);
    last_frame_ = leaves;
    TruthRecord truth = *frame;
    follow_counter(truth);
    if (flagged_left_ > 0 && (truth.values.flag & wire::kFlagError) != 0) {
        count(FaultKind::error_flags);
        if (--flagged_left_ == 0) clear_diagnostics(machine_, steady_);
    }
    while (const auto due = schedule_.take_due(truth.utc, frames_made_)) apply(*due, leaves);
    ++frames_made_;
    send_frame(bytes, leaves, truth);
}

void FaultInjector::send_answer(std::span<const std::byte> bytes, UtcTime leaves) {
    if (leaves < muted_until_) return;
    if (answers_cut_frames_ && machine_.is_sampling()) {
        held_answer_.insert(held_answer_.end(), bytes.begin(), bytes.end());
    } else {
        line_.send(bytes, leaves, nullptr);
    }
}

void FaultInjector::send_frame(std::span<const std::byte> bytes, UtcTime leaves,
                               TruthRecord truth) {
    if (leaves < muted_until_) {
        count(FaultKind::silence);
        truth.fate = Fate::lost;
        line_.send({}, leaves, &truth);
        return;
    }
    if (!held_answer_.empty()) {
        truth.fate = Fate::damaged;
        line_.send(cut_by_answer(bytes, held_answer_, places_), leaves, &truth);
        held_answer_.clear();
        ++report_.frames_cut;
        return;
    }
    for (std::size_t i = 0; i < waiting_.size() && !held_frame_; ++i) {
        const Fault fault = waiting_[i].fault;
        if (fault.kind == FaultKind::bad_checksum && !has_right_checksum(bytes)) continue;
        if (--waiting_[i].frames == 0) {
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
        }
        count(fault.kind);
        return spoil(fault, bytes, leaves, truth);
    }
    line_.send(bytes, leaves, &truth);
    release_held(leaves);
}

void FaultInjector::spoil(const Fault& fault, std::span<const std::byte> bytes, UtcTime leaves,
                          TruthRecord truth) {
    const auto send_damaged = [&](const Bytes& spoilt) {
        truth.fate = Fate::damaged;
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
            truth.fate = Fate::lost;
            return line_.send({}, leaves, &truth);
        case FaultKind::garbage:
            report_.bytes_garbage += fault.bytes;
            line_.send_garbage(garbage(fault.bytes, places_), leaves);
            return line_.send(bytes, leaves, &truth);
        case FaultKind::duplicate_frame:
            line_.send(bytes, leaves, &truth);
            truth.fate = Fate::repeated;
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
    held_frame_->truth.fate = Fate::misplaced;
    line_.send(held_frame_->bytes, leaves, &held_frame_->truth);
    held_frame_.reset();
}

/// Says what the counter of this frame is worth and moves it on for the next one.
void FaultInjector::follow_counter(TruthRecord& truth) {
    if (is_next_misplaced_) truth.fate = Fate::misplaced;
    is_next_misplaced_ = false;
    if (stuck_left_ == 0) return;
    truth.fate = Fate::repeated;
    count(FaultKind::counter_stuck);
    const int steps = --stuck_left_ == 0 ? stuck_frames_ : -1;
    machine_.jump_counter(static_cast<std::uint16_t>(steps * count_step()));
}

/// The next frames show the COUNT of this one; then it is what it would have been.
void FaultInjector::stop_counter(int frames) {
    if (stuck_left_ > 0) return;
    stuck_frames_ = stuck_left_ = frames;
    machine_.jump_counter(static_cast<std::uint16_t>(-count_step()));
}

void FaultInjector::jump(const Fault& fault) {
    const unsigned ticks = fault.ticks > 0 ? static_cast<unsigned>(fault.ticks)
                                           : static_cast<unsigned>(fault.count) * count_step();
    is_next_misplaced_ = ticks % count_step() != 0 || (ticks & 0xFFFFU) >= kHalfRange;
    machine_.jump_counter(static_cast<std::uint16_t>(ticks & 0xFFFFU));
}

void FaultInjector::put_other_unit() {
    machine_.rename(identity_);
    machine_.power_cycle(steady_);
    is_unit_waiting_ = false;
}

void FaultInjector::apply(const Fault& fault, UtcTime simulated) {
    if (fault.kind == FaultKind::oven && !(oven_ && oven_(fault.name, fault.count))) {
        throw InputError(fault.name + ": no oven takes it; allowed: with --oven-link");
    }
    report_.applied.push_back({fault.name, simulated, frames_made_});
    const UtcTime end = simulated + from_seconds(fault.seconds);
    switch (fault.kind) {
        case FaultKind::flip_bit:
        case FaultKind::bad_checksum:
        case FaultKind::drop_bytes:
        case FaultKind::insert_bytes:
        case FaultKind::garbage:
        case FaultKind::duplicate_frame:
        case FaultKind::reorder_frames:
        case FaultKind::truncate_frame:
        case FaultKind::lose_frames:
            waiting_.push_back({fault, fault.count});
            return;
        case FaultKind::counter_stuck:
            return stop_counter(fault.count);
        case FaultKind::error_flags:
            flagged_left_ = fault.count;
            return machine_.raise_diagnostics(static_cast<std::uint16_t>(fault.diag_stat));
        case FaultKind::silence:
            muted_until_ = end;
            return;
        case FaultKind::counter_jump:
            jump(fault);
            break;
        case FaultKind::counter_reset:
            is_next_misplaced_ = true;
            machine_.jump_counter(static_cast<std::uint16_t>(-machine_.value_of(kCount)));
            break;
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
            hang_up_ = HangUp{end, fault.loses_power};
            if (fault.loses_power) machine_.power_cycle(steady_);
            line_.unplug(simulated);
            break;
        case FaultKind::overrun:
            overrun_until_ = fault.seconds > 0.0 ? end : UtcTime::max();
            break;
        case FaultKind::oven:
            break;
    }
    count(fault.kind);
}

void FaultInjector::catch_up(const Instant& now) {
    const bool comes_nothing =
        !machine_.is_sampling() || (now.simulated - last_frame_ > kNoFrames && !line_.is_full());
    if (!comes_nothing) return;
    if (held_frame_) {
        line_.send(held_frame_->bytes, now.simulated, &held_frame_->truth);
        held_frame_.reset();
    }
    while (const auto due = schedule_.take_due(now.simulated, frames_made_)) {
        apply(*due, now.simulated);
    }
}

std::optional<FaultInjector::HangUp> FaultInjector::take_hang_up() {
    return std::exchange(hang_up_, std::nullopt);
}

void FaultInjector::came_back(const HangUp& hang_up, const Instant& now) {
    steady_ = now.steady;
    line_.plug_in();
    if (is_unit_waiting_) return put_other_unit();
    if (hang_up.loses_power) machine_.power_cycle(now.steady);
}

}  // namespace a351::sim
