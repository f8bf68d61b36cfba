#include "sim/replay/replay_device.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace a351::sim::replay {
namespace {

/// Wait while the host does not sample: nothing is due, and the host's commands wake the port.
constexpr Nanoseconds kIdle = std::chrono::hours(1);

/// Returns the factory state with the recorded baud rate.
device::FlashMemory flash_of(const RecordedUnit& unit) {
    device::FlashMemory flash;
    std::size_t i = 0;
    for (const wire::Register& reg : wire::kRegisters) {
        if (&reg == &wire::kUartCtrl) {
            const auto coded =
                std::ranges::find(unit.profile->baud_rates, unit.baud, &wire::Coded::value);
            flash.settings[i] = static_cast<std::uint16_t>(coded->code << 8U);
        }
        if (reg.is_saved_in_flash) ++i;
    }
    return flash;
}

}  // namespace

Device::Device(std::unique_ptr<Recording> recording, Timing timing, Nanoseconds now)
    : recording_(std::move(recording)), timing_(timing) {
    install_unit(now);
    first_due_ = *recording_->next_due(*machine_);
}

/// Replaces the machine by the recorded unit, long enough after power-on to be ready.
void Device::install_unit(Nanoseconds now) {
    const RecordedUnit& unit = recording_->unit();
    machine_ = std::make_unique<device::RegisterMachine>(
        *unit.profile, unit.identity, now - device::power_on_time(*unit.profile), flash_of(unit));
    run_ = machine_->sampling_run();
}

void Device::receive(std::span<const std::byte> bytes, const device::Instant& now,
                     device::LineSink& line) {
    answers_.clear();
    if (machine_->is_sampling()) {
        machine_->fall_back_to_configuration();
        const auto unseen = line.take_back();
        taken_back_.insert(taken_back_.begin(), unseen.begin(), unseen.end());
    }
    machine_->receive(bytes, now.steady, answers_);
    if (!answers_.empty()) line.send(answers_, now.simulated, nullptr);
    if (machine_->is_sampling() && machine_->sampling_run() != run_) begin_sampling(now.simulated);
}

void Device::begin_sampling(UtcTime now) {
    run_ = machine_->sampling_run();
    sampling_since_ = now;
    const std::string objection = recording_->objection(*machine_);
    if (!objection.empty()) throw std::runtime_error(objection);
    if (is_over_) return;
    if (report_.sessions == 0 && timing_ == Timing::from_host_start)
        shift_ = now - *recording_->next_due(*machine_);
    const auto due = recording_->next_due(*machine_);
    if (!has_begun_) {
        ++report_.sessions;
    } else if (due && simulated(*due) < now) {
        ++report_.restarts;
        report_.longest_delay = std::max(report_.longest_delay, now - simulated(*due));
    }
    has_begun_ = true;
}

UtcTime Device::simulated(UtcTime recorded) const {
    return timing_ == Timing::as_fast_as_read ? now_ : recorded + shift_;
}

void Device::advance_to(const device::Instant& now, device::LineSink& line) {
    now_ = now.simulated;
    if (is_over_ || !machine_->is_sampling()) return;
    if (!taken_back_.empty())
        line.send(std::exchange(taken_back_, {}), std::max(now_, sampling_since_), nullptr);
    while (const auto due = recording_->next_due(*machine_)) {
        if (simulated(*due) > now_ || line.is_full()) return;
        recording_->send_next(*machine_, std::max(simulated(*due), sampling_since_), line);
        ++report_.pieces;
    }
    end_session(now.steady);
}

void Device::end_session(Nanoseconds now) {
    machine_->fall_back_to_configuration();
    has_begun_ = false;
    const RecordedUnit before = recording_->unit();
    is_over_ = !recording_->begin_next_session();
    if (!is_over_ && before != recording_->unit()) install_unit(now);
}

std::optional<UtcTime> Device::next_due() const {
    if (is_over_) return std::nullopt;
    if (!machine_->is_sampling()) return now_ + kIdle;
    const auto due = recording_->next_due(*machine_);
    return due ? simulated(*due) : now_;
}

}  // namespace a351::sim::replay
