#include "corrector/long_record/stretch_builder.hpp"

#include <algorithm>
#include <cmath>

namespace a351::corrector::long_record {
namespace {

double norm_at(const std::vector<std::vector<double>>& channels, std::size_t i) {
    if (channels.size() == 2) return channels[0][i];
    return std::sqrt(channels[0][i] * channels[0][i] + channels[1][i] * channels[1][i] +
                     channels[2][i] * channels[2][i]);
}

/// Widens a range by a value; NaN is ignored.  std::fmin() and std::fmax() would do the same, but
/// are function calls.
void widen(double& low, double& high, double value) {
    if (!(value >= low)) low = std::isnan(value) ? low : value;
    if (!(value <= high)) high = std::isnan(value) ? high : value;
}

}  // namespace

StretchBuilder::StretchBuilder(int stages, std::size_t axes) : outputs_(axes + 1) {
    for (int stage = 0; stage < stages; ++stage) inputs_per_sample_ *= kRecordFactor;
    if (stages > 0)
        decimators_.assign(axes + 1,
                           signal::Decimator(signal::design_decimation(kRecordFactor), stages));
}

void StretchBuilder::push(const std::vector<std::vector<double>>& channels) {
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
        if (decimators_.empty())
            outputs_[k].insert(outputs_[k].end(), channels[k].begin(), channels[k].end());
        else
            decimators_[k].push(channels[k], outputs_[k]);
    }
    if (!decimators_.empty()) add_to_ranges(channels);
    input_count_ += static_cast<std::int64_t>(channels.front().size());
}

void StretchBuilder::add_to_ranges(const std::vector<std::vector<double>>& channels) {
    const std::size_t count = channels.front().size();
    const auto per_sample = static_cast<std::size_t>(inputs_per_sample_);
    auto at = static_cast<std::size_t>(input_count_);
    for (std::size_t i = 0; i < count;) {
        if (at / per_sample >= raw_.size()) raw_.push_back({kNaN, kNaN, kNaN, kNaN});
        const std::size_t end = std::min(count, i + per_sample - at % per_sample);
        RecordStretch::RawRange& range = raw_.back();
        at += end - i;
        for (; i < end; ++i) {
            widen(range.acceleration_low_mgal, range.acceleration_high_mgal, norm_at(channels, i));
            widen(range.temperature_low_degc, range.temperature_high_degc, channels.back()[i]);
        }
    }
}

void StretchBuilder::set_time(std::int64_t k, UtcTime time) {
    const auto place = static_cast<std::size_t>(k);
    if (place >= times_.size()) times_.resize(place + 1);
    times_[place] = time;
}

RecordStretch StretchBuilder::finish(double step_s) {
    for (std::size_t k = 0; k < decimators_.size(); ++k) decimators_[k].finish(outputs_[k]);
    RecordStretch stretch;
    const std::size_t count = outputs_.front().size();
    times_.resize(count);
    for (const auto& time : times_)
        stretch.times.push_back(time ? *time : stretch.times.back() + from_seconds(step_s));
    stretch.quantity.resize(count);
    for (std::size_t k = 0; k < count; ++k) stretch.quantity[k] = norm_at(outputs_, k);
    stretch.temperature_degc = std::move(outputs_.back());
    outputs_.pop_back();
    if (outputs_.size() > 1) stretch.axes_mgal = std::move(outputs_);
    stretch.raw = std::move(raw_);
    return stretch;
}

}  // namespace a351::corrector::long_record
