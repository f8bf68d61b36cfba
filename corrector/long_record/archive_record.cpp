#include "corrector/long_record/archive_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/archive_series/sample_grid.hpp"
#include "corrector/archive_series/samples.hpp"
#include "corrector/archive_series/temperature_course.hpp"
#include "corrector/long_record/csv_record.hpp"
#include "corrector/long_record/stretch_builder.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector::long_record {
namespace {

using archive_series::Epoch, archive_series::kOuter, archive_series::kTemperature;
using archive_series::kBlockSamples, archive_series::NumberedSamples;
using std::chrono::days;

constexpr std::size_t kChannels = kTemperature + 1;
constexpr std::size_t kLeading = archive_series::kVertical;  // its gaps divide the record
constexpr double kSameRate = 1e-3;  // relative; ten times the error of a sensor's clock

/// The samples of a day, or of an epoch's part of it.
using DayOfChannels = std::vector<archive::ChannelData>;

/// Turns the days of four channels into stretches.
class ArchiveStream {
public:
    explicit ArchiveStream(LongRecord& record) : record_(record) {}

    /// Sets the epoch of all samples taken from here on; a change begins a new stretch.
    void use(const Epoch& epoch) {
        if (epoch_ == &epoch) return;
        if (text::Message change;
            epoch_ != nullptr && !(change = epoch_change(*epoch_, epoch)).empty())
            divide(std::move(change), epoch.start);
        epoch_ = &epoch;
    }

    /// Adds the samples of a day, or of an epoch's part of it, after those taken so far.
    void take(const DayOfChannels& day) {
        for (const archive::Segment& segment : day[kLeading].segments) {
            const UtcTime start = segment.time_of(0);
            if (rate_hz_ == 0.0) begin(segment.rate_hz);
            if (!has_rate(segment)) {
                push(day);
                divide(text::message("another rate: {} Hz after {} Hz",
                                     text::shortest(segment.rate_hz), text::shortest(rate_hz_)),
                       start);
                begin(segment.rate_hz);
            }
            std::int64_t first = 0;
            if (builder_) {
                const double late = seconds_between(next_time_, start) * rate_hz_;
                if (late > -0.5 && late < kLongestGap_s * rate_hz_) {
                    first = next() + std::llround(late);
                } else {
                    push(day);
                    end_stretch();
                    if (late <= -0.5)
                        record_.warnings.push_back(text::message(
                            "at {} the time of the archive goes back by {} s", to_rfc3339(start),
                            text::shortest(seconds_between(start, next_time_))));
                }
            }
            if (!builder_) builder_.emplace(stages_, kChannels - 1);
            add(segment, first);
        }
        push(day);
    }

    void end_stretch() {
        if (!builder_) return;
        record_.stretches.push_back(builder_->finish(record_.step_s));
        record_.stretches.back().serial_number = epoch_->serial_number;
        record_.stretches.back().begins_with = std::exchange(change_, {});
        builder_.reset();
    }

private:
    [[nodiscard]] bool has_rate(const archive::Segment& segment) const {
        return std::abs(segment.rate_hz / rate_hz_ - 1.0) <= kSameRate;
    }

    void begin(double rate_hz) {
        const auto stages = record_stages(1.0 / rate_hz);
        if (!stages)
            throw InputError(
                fmt::format("archive: rate = {} Hz; allowed: 0.05, 0.5, 5 or 50 Hz within 10 %",
                            text::shortest(rate_hz)));
        stages_ = *stages;
        const double step_s = std::pow(kRecordFactor, stages_) / rate_hz;
        if (rate_hz_ == 0.0) {
            record_.raw_rate_hz = rate_hz;
            record_.step_s = step_s;
        } else if (std::abs(step_s / record_.step_s - 1.0) > kSameRate) {
            throw InputError(fmt::format(
                "archive: rate = {} Hz after {} Hz; allowed: rates that differ by factors of 10",
                text::shortest(rate_hz), text::shortest(rate_hz_)));
        }
        rate_hz_ = rate_hz;
    }

    /// Ends the stretch; the next one begins with this change.
    void divide(text::Message change, UtcTime time) {
        end_stretch();
        record_.warnings.push_back(
            text::message("from {} on, {}; the record is divided there", to_rfc3339(time), change));
        change_ = std::move(change);
    }

    /// Returns the number of the sample that would continue the stretch.
    [[nodiscard]] std::int64_t next() const {
        return leading_.empty() ? builder_->input_count() : leading_.back().end();
    }

    /// Adds a segment of the vertical axis, whose first sample has this number in the stretch.
    void add(const archive::Segment& segment, std::int64_t first) {
        leading_.push_back({segment.counts, first});
        for (const archive::Segment::Anchor& anchor : segment.anchors)
            times_.push_back({anchor.time, first + static_cast<std::int64_t>(anchor.offset)});
        const std::int64_t step = builder_->inputs_per_sample();
        for (std::int64_t k = (first + step - 1) / step; k * step < next(); ++k)
            builder_->set_time(k, segment.time_of(static_cast<std::size_t>(k * step - first)));
        next_time_ = segment.time_of(segment.counts.size() - 1) + from_seconds(1.0 / rate_hz_);
    }

    /// Returns the channel's samples, numbered like those of the vertical axis at the same times.
    [[nodiscard]] std::vector<NumberedSamples> place(const archive::ChannelData& channel) const {
        std::vector<NumberedSamples> placed;
        for (const archive::Segment& segment : channel.segments) {
            if (!has_rate(segment)) continue;
            const UtcTime start = segment.time_of(0);
            auto beside = std::ranges::upper_bound(times_, start, {}, &TimeOfNumber::time);
            if (beside != times_.begin()) --beside;
            const double samples = seconds_between(beside->time, start) * rate_hz_;
            placed.push_back({segment.counts, beside->number + std::llround(samples)});
        }
        return placed;
    }

    /// Adds the samples taken since the last call to the stretch.
    void push(const DayOfChannels& day) {
        if (leading_.empty()) return;
        const std::int64_t end = next();
        std::array<std::vector<NumberedSamples>, kChannels> placed;
        for (std::size_t k = 0; k < kChannels; ++k)
            placed[k] = k == kLeading ? std::exchange(leading_, {}) : place(day[k]);
        while (builder_->input_count() < end) {
            const std::int64_t at = builder_->input_count();
            const auto count = std::min(kBlockSamples, static_cast<std::size_t>(end - at));
            for (std::size_t k = 0; k < kChannels; ++k) {
                const double unit = k == kTemperature ? 1.0 : kMilliGalPerMps2;
                const station::ChannelScale& scale = epoch_->channels[k];
                block_[k].resize(count);
                archive_series::fill(block_[k], at, placed[k], unit * scale.gain,
                                     unit * scale.offset);
            }
            builder_->push(block_);
        }
        times_.clear();
    }

    /// A time stamp of the vertical axis and the number of its sample.
    struct TimeOfNumber {
        UtcTime time;
        std::int64_t number;
    };

    LongRecord& record_;
    const Epoch* epoch_ = nullptr;
    text::Message change_;  ///< Change with which this stretch begins, or the next one.
    double rate_hz_ = 0.0;  ///< Rate; 0: no sample yet.
    int stages_ = 0;
    std::optional<StretchBuilder> builder_;
    std::vector<NumberedSamples> leading_;  ///< Samples that are not in the stretch yet.
    std::vector<TimeOfNumber> times_;       ///< Their time stamps.
    UtcTime next_time_;                     ///< Time of the sample that would continue the stretch.
    std::vector<std::vector<double>> block_{kChannels};
};

/// Sets the outer oven's temperature of the stretches: NaN in its gaps, with a warning.
void set_outer(LongRecord& record, const std::vector<archive_series::MinuteTemperature>& outer) {
    for (RecordStretch& stretch : record.stretches) {
        stretch.outer_degc =
            archive_series::interpolated(outer, stretch.times, archive_series::kLongestOuterGap);
        const auto gap = std::ranges::find_if(stretch.outer_degc,
                                              [](double value) { return std::isnan(value); });
        if (gap == stretch.outer_degc.end()) continue;
        const UtcTime time =
            stretch.times[static_cast<std::size_t>(gap - stretch.outer_degc.begin())];
        record.warnings.push_back(text::message(
            "at {} the temperature of the outer oven has a gap of more than 10 min; a segment with "
            "such a gap does not use it",
            to_rfc3339(time)));
    }
}

void remove_tide(LongRecord& record, const station::Position& position, tide::System system) {
    const tide::Station station{position.latitude, position.longitude, position.elevation};
    const MilliGal kept = tide::kept_permanent_tide(system, station, tide::Factors());
    for (RecordStretch& stretch : record.stretches)
        for (std::size_t i = 0; i < stretch.size(); ++i)
            stretch.quantity[i] -= (tide::direct_tide(stretch.times[i], station) - kept).value();
    record.is_tide_removed = true;
}

void describe_inputs(LongRecord& record, const std::filesystem::path& root,
                     const std::vector<Epoch>& epochs, UtcTime begin, UtcTime end) {
    std::vector<std::filesystem::path> files;
    for (const Epoch& epoch : epochs)
        for (auto& file : archive_series::files_of(root, epoch, {begin, begin, end}))
            if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
    std::vector<text::InputFile> inputs(files.size());
    archive_series::on_all_cores(files.size(), [&](std::size_t i) {
        inputs[i] = text::describe_input("archive", files[i]);
    });
    record.inputs.insert(record.inputs.end(), inputs.begin(), inputs.end());
}

}  // namespace

LongRecord read_archive_record(const std::filesystem::path& root, const RecordWindow& window,
                               const archive_series::Progress& progress, tide::System system) {
    const std::filesystem::path metadata = root / "metadata" / "station.xml";
    const std::vector<Epoch> epochs = archive_series::read_epochs(metadata);
    const UtcTime begin = window.from.value_or(UtcTime::min());
    const UtcTime end = window.to.value_or(UtcTime::max());
    std::set<UtcTime> of_days;
    for (const Epoch& epoch : epochs)
        for (const auto& file : archive::day_files(root / "archive", epoch.codes,
                                                   epoch.channels[kLeading].code, begin, end))
            of_days.insert(archive::day_of(file));

    LongRecord record;
    for (const auto& one : archive_series::absent_files(root, begin, end))
        record.warnings.push_back(archive_series::to_message(one));
    ArchiveStream stream(record);
    std::vector<archive_series::MinuteTemperature> outer;
    bool has_outer = false;
    text::Message rate_remark;
    DayOfChannels samples;
    std::size_t done = 0;
    for (const UtcTime day : of_days) {
        for (std::size_t e = 0; e < epochs.size(); ++e) {
            // [from, to) is the epoch's part of the day.
            const Epoch& epoch = epochs[e];
            const UtcTime from = std::max({day, begin, e == 0 ? UtcTime::min() : epoch.start});
            const UtcTime to = std::min(
                {day + days(1), end, e + 1 < epochs.size() ? epochs[e + 1].start : UtcTime::max()});
            if (from >= to) continue;
            samples =
                archive_series::read_samples(root, epoch, {from, from, to}, std::move(samples));
            for (std::size_t k = 0; k < kChannels; ++k)
                archive_series::add_damage(record.warnings, samples[k]);
            if (rate_remark.empty()) {
                rate_remark = archive_series::rate_remark(samples);
                if (!rate_remark.empty()) record.warnings.push_back(rate_remark);
            }
            if (samples[kLeading].segments.empty()) continue;
            stream.use(epoch);
            stream.take(samples);
            if (!epoch.has_outer()) continue;
            has_outer = true;
            archive_series::add_damage(record.warnings, samples[kOuter]);
            const auto course = archive_series::temperature_course(samples[kOuter].segments,
                                                                   epoch.channels[kOuter]);
            outer.insert(outer.end(), course.begin(), course.end());
        }
        progress(++done, of_days.size());
    }
    stream.end_stretch();
    if (record.stretches.empty())
        throw InputError(fmt::format(
            "{}: archive: no sample of {}; allowed: an archive with samples from --from to --to",
            root.string(), epochs.back().channels[kLeading].code));
    if (has_outer) set_outer(record, outer);
    if (const auto& position = epochs.front().position)
        remove_tide(record, *position, system);
    else
        record.warnings.push_back(
            text::message("{}: no position: the tide is not removed", metadata.string()));
    record.data_sheet_mgal_per_sqrt_hz = epochs.front().data_sheet_mgal_per_sqrt_hz;
    record.source = root;
    record.inputs.push_back(text::describe_input("metadata", metadata));
    describe_inputs(record, root, epochs, begin, end);
    return record;
}

}  // namespace a351::corrector::long_record
