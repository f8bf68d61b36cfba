#include "sim/replay/archive_recording.hpp"

namespace a351::sim {
namespace {

/// Samples, more than any transient has: twice the longest long-term filter (M-A352AD10 data sheet,
/// 7.19) and the 127 samples of table 5.4.
constexpr int kMostSuppressed = 2 * 4096 + 127;

}  // namespace

ArchiveRecording::ArchiveRecording(std::unique_ptr<ArchiveSource> source, RecordedUnit unit)
    : source_(std::move(source)), unit_(std::move(unit)) {}

std::optional<UtcTime> ArchiveRecording::next_due(const RegisterMachine& machine) const {
    const auto instant = source_->next_instant();
    if (!instant || is_session_over_) return std::nullopt;
    return *instant + machine.frame_delay();
}

void ArchiveRecording::send_next(RegisterMachine& machine, UtcTime leaves, LineSink& line) {
    const TimedSample sample = source_->next();
    bytes_.clear();
    std::optional<wire::BurstValues> values;
    if (machine.sampling_run() == run_) {
        while (next_index_ < sample.index) {
            machine.skip_sample();
            ++next_index_;
        }
        values = machine.sample(sample.values, bytes_);
    } else {
        run_ = machine.sampling_run();
        for (int i = 0; i <= kMostSuppressed && !values; ++i) {
            values = machine.sample(sample.values, bytes_);
        }
    }
    next_index_ = sample.index + 1;
    is_session_over_ = source_->begins_run();
    if (!values) return;
    TruthRecord truth;
    truth.utc = sample.instant;
    truth.values = *values;
    truth.sampling_run = static_cast<std::uint16_t>(run_);
    truth.grid_index = static_cast<std::uint32_t>(sample.index);
    line.send(bytes_, leaves, &truth);
}

bool ArchiveRecording::begin_next_session() {
    is_session_over_ = false;
    return source_->next_instant().has_value();
}

std::string ArchiveRecording::objection(const RegisterMachine& machine) const {
    if (machine.output_rate_hz() != source_->rate_hz()) {
        return "the host asks for " + std::to_string(machine.output_rate_hz()) +
               " Hz; the archive has " + std::to_string(source_->rate_hz()) + " Hz";
    }
    if ((machine.value_of(wire::kUartCtrl) & wire::kUartAuto) == 0 ||
        (machine.value_of(wire::kMscCtrl) & wire::kMscExternalTrigger) != 0) {
        return "the host asks for manual or triggered sampling; a replay sends by itself";
    }
    const auto layout = wire::BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(
        machine.value_of(wire::kBurstCtrl) & wire::kBurstCtrl.defined_bits));
    if (!layout) return "the host asks for frames without an axis";
    for (std::size_t field = 0; field < ArchiveSource::kFields.size(); ++field) {
        const bool is_asked = field == 3 ? layout->has_temperature()
                                         : layout->has_axis(static_cast<wire::Axis>(field));
        if (is_asked && !source_->has_field(field)) {
            return "the host asks for " + std::string(ArchiveSource::kFields[field]) +
                   ", which the archive lacks";
        }
    }
    return {};
}

}  // namespace a351::sim
