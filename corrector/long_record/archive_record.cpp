#include "corrector/long_record/archive_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "corrector/long_record/csv_record.hpp"
#include "corrector/long_record/record_epochs.hpp"
#include "corrector/long_record/stretch_builder.hpp"
#include "corrector/reading/occupation_window.hpp"
#include "corrector/reading/temperature_course.hpp"
#include "corrector/tide/earth_tide.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/station/station_document.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector::long_record {
namespace {

using std::chrono::days;
using Day = std::chrono::sys_time<days>;

constexpr std::size_t kChannels = kRecordChannels;
constexpr std::size_t kLeading = 2;  // the channel whose gaps divide the record; any axis would do
constexpr std::int64_t kBlockSamples = 16384;  // so that a channel's block fits in the cache
constexpr double kSameRate = 1e-3;             // relative; ten times the error of a sensor's clock

using DayOfChannels = std::array<archive::ChannelData, kChannels>;

/// A segment with the number of its first sample in the stretch.
struct Placed {
    const archive::Segment* segment;
    std::int64_t first;
    [[nodiscard]] std::int64_t behind() const {
        return first + static_cast<std::int64_t>(segment->counts.size());
    }
};

/// Turns the days of four channels into stretches.
class ArchiveStream {
public:
    explicit ArchiveStream(LongRecord& record) : record_(record) {}

    /// Sets the epoch of all samples taken from here on; a change begins a new stretch.
    void use(const RecordEpoch& epoch) {
        if (epoch_ == &epoch) return;
        if (std::string change = epoch_ == nullptr ? "" : epoch_change(*epoch_, epoch);
            !change.empty())
            divide(std::move(change), epoch.start);
        epoch_ = &epoch;
    }

    /// Adds the samples of a day, or of an epoch's part of it, after those taken so far.
    void take(const DayOfChannels& day) {
        std::vector<Placed> run;
        for (const archive::Segment& segment : day[kLeading].segments) {
            const UtcTime start = segment.time_of(0);
            if (rate_hz_ == 0.0) begin(segment.rate_hz);
            if (!has_rate(segment)) {
                push(run, day);
                divide(text::message("another rate: {} Hz after {} Hz",
                                     text::shortest(segment.rate_hz), text::shortest(rate_hz_)),
                       start);
                begin(segment.rate_hz);
            }
            std::int64_t first = 0;
            if (builder_) {
                const double late = seconds_between(next_time_, start) * rate_hz_;
                if (late > -0.5 && late < kLongestGap_s * rate_hz_) {
                    first = next_ + std::llround(late);
                } else {
                    push(run, day);
                    end_stretch();
                    if (late <= -0.5)
                        record_.warnings.push_back(text::message(
                            "at {} the time of the archive goes back by {} s", to_rfc3339(start),
                            text::shortest(seconds_between(start, next_time_))));
                }
            }
            if (!builder_) builder_.emplace(stages_, kChannels - 1);
            run.push_back({&segment, first});
            note_times(run.back());
            next_ = run.back().behind();
            next_time_ = segment.time_of(segment.counts.size() - 1) + from_seconds(1.0 / rate_hz_);
        }
        push(run, day);
    }

    void end_stretch() {
        if (!builder_) return;
        record_.stretches.push_back(builder_->finish(record_.step_s));
        record_.stretches.back().serial_number = epoch_->serial_number;
        record_.stretches.back().begins_with = std::exchange(change_, {});
        builder_.reset();
        next_ = 0;
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

    void note_times(const Placed& placed) {
        const std::int64_t step = builder_->inputs_per_sample();
        for (std::int64_t k = (placed.first + step - 1) / step; k * step < placed.behind(); ++k) {
            const auto offset = static_cast<std::size_t>(k * step - placed.first);
            builder_->set_time(k, placed.segment->time_of(offset));
        }
    }

    /// Returns the channel's segments, numbered like the samples of the vertical axis at the same
    /// times.
    [[nodiscard]] std::vector<Placed> place(const archive::ChannelData& channel,
                                            const std::vector<Placed>& run) const {
        std::vector<Placed> placed;
        for (const archive::Segment& segment : channel.segments) {
            if (!has_rate(segment)) continue;
            const UtcTime start = segment.time_of(0);
            const Placed* beside = &run.front();
            for (const Placed& candidate : run)
                if (candidate.segment->time_of(0) <= start) beside = &candidate;
            const auto& anchors = beside->segment->anchors;
            auto after = std::upper_bound(
                anchors.begin(), anchors.end(), start,
                [](UtcTime time, const auto& anchor) { return time < anchor.time; });
            if (after != anchors.begin()) --after;
            const double behind = seconds_between(after->time, start) * rate_hz_;
            placed.push_back({&segment, beside->first + static_cast<std::int64_t>(after->offset) +
                                            std::llround(behind)});
        }
        return placed;
    }

    /// Adds the samples of a run to the stretch and clears the run.
    void push(std::vector<Placed>& run, const DayOfChannels& day) {
        if (run.empty()) return;
        std::array<std::vector<Placed>, kChannels> placed;
        for (std::size_t k = 0; k < kChannels; ++k)
            placed[k] = k == kLeading ? run : place(day[k], run);
        const std::int64_t behind = run.back().behind();
        for (std::int64_t at = builder_->input_count(); at < behind; at += kBlockSamples) {
            const auto count = static_cast<std::size_t>(std::min(kBlockSamples, behind - at));
            for (std::size_t k = 0; k < kChannels; ++k) fill(block_[k], placed[k], k, at, count);
            builder_->push(block_);
        }
        run.clear();
    }

    void fill(std::vector<double>& values, const std::vector<Placed>& placed, std::size_t channel,
              std::int64_t at, std::size_t count) const {
        values.assign(count, kNaN);
        const double unit = channel < kChannels - 1 ? kMilliGalPerMps2 : 1.0;
        const station::ChannelScale& scale = epoch_->scales.at(channel);
        const double gain = unit * scale.gain, offset = unit * scale.offset;
        const std::int64_t behind = at + static_cast<std::int64_t>(count);
        for (const Placed& part : placed) {
            const std::int64_t end = std::min(part.behind(), behind);
            for (std::int64_t i = std::max(part.first, at); i < end; ++i)
                values[static_cast<std::size_t>(i - at)] =
                    offset + gain * part.segment->counts[static_cast<std::size_t>(i - part.first)];
        }
    }

    LongRecord& record_;
    const RecordEpoch* epoch_ = nullptr;
    std::string change_;    ///< Change with which this stretch begins, or the next one.
    double rate_hz_ = 0.0;  ///< Rate; 0: no sample yet.
    int stages_ = 0;
    std::optional<StretchBuilder> builder_;
    std::int64_t next_ = 0;  ///< Number of the sample that would continue the stretch.
    UtcTime next_time_;      ///< Its time.
    std::vector<std::vector<double>> block_{kChannels};
};

/// Sets the outer oven's temperature of the stretches: NaN in its gaps, with a warning.
void set_outer(LongRecord& record, const std::vector<reading::MinuteTemperature>& outer) {
    for (RecordStretch& stretch : record.stretches) {
        if (outer.empty())
            stretch.outer_degc.assign(stretch.size(), kNaN);
        else
            stretch.outer_degc =
                reading::interpolated(outer, stretch.times, reading::kLongestOuterGap);
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

std::optional<tide::Station> position_of(const std::filesystem::path& metadata) {
    const auto document = station::load_station_document(metadata);
    const auto station = document.child("FDSNStationXML").child("Network").child("Station");
    if (!station.child("Latitude") || !station.child("Longitude")) return std::nullopt;
    return tide::Station{Degrees(station.child("Latitude").text().as_double()),
                         Degrees(station.child("Longitude").text().as_double()),
                         Metres(station.child("Elevation").text().as_double())};
}

void remove_tide(LongRecord& record, const tide::Station& station) {
    for (RecordStretch& stretch : record.stretches)
        for (std::size_t i = 0; i < stretch.size(); ++i)
            stretch.acceleration_mgal[i] -= tide::direct_tide(stretch.times[i], station).value();
    record.is_tide_removed = true;
}

/// Returns the days in the window for which a channel has a file.
std::set<Day> days_with_files(const std::filesystem::path& archive,
                              const journal::StationCodes& codes, const std::string& channel,
                              const RecordWindow& window) {
    std::set<Day> found;
    for (const auto& file : archive::day_files(archive, codes, channel)) {
        const std::string name = file.filename().string();  // ends with .YEAR.DAY in digits
        const char* const end = name.data() + name.size();
        int year = 0, day = 0;
        std::from_chars(end - 8, end - 4, year);
        std::from_chars(end - 3, end, day);
        const Day first = Day(std::chrono::year(year) / 1 / 1) + days(day - 1);
        if (window.from && UtcTime(first + days(1)) <= *window.from) continue;
        if (window.to && UtcTime(first) >= *window.to) continue;
        found.insert(first);
    }
    return found;
}

void describe_inputs(LongRecord& record, const std::filesystem::path& root,
                     const std::vector<RecordEpoch>& epochs, const std::set<Day>& of_days) {
    std::vector<std::filesystem::path> files;
    const auto add = [&](const RecordEpoch& epoch, const std::string& channel) {
        for (const Day day : of_days) {
            auto file = archive::sds_file(root / "archive", epoch.codes, channel, day);
            if (std::filesystem::exists(file) && std::ranges::find(files, file) == files.end())
                files.push_back(std::move(file));
        }
    };
    for (std::size_t k = 0; k < kChannels; ++k)
        for (const RecordEpoch& epoch : epochs) add(epoch, epoch.scales.at(k).code);
    for (const RecordEpoch& epoch : epochs)
        if (epoch.outer) add(epoch, epoch.outer->code);
    std::vector<text::InputFile> inputs(files.size());
    reading::on_all_cores(files.size(), [&](std::size_t i) {
        inputs[i] = text::describe_input("archive", files[i]);
    });
    record.inputs.insert(record.inputs.end(), inputs.begin(), inputs.end());
}

}  // namespace

LongRecord read_archive_record(const std::filesystem::path& root, const RecordWindow& window,
                               const reading::Progress& progress) {
    const std::filesystem::path metadata = root / "metadata" / "station.xml";
    const std::filesystem::path archive = root / "archive";
    const std::vector<RecordEpoch> epochs = read_record_epochs(metadata);
    std::set<Day> of_days;
    for (const RecordEpoch& epoch : epochs)
        of_days.merge(days_with_files(archive, epoch.codes, epoch.scales[kLeading].code, window));

    LongRecord record;
    ArchiveStream stream(record);
    std::vector<reading::MinuteTemperature> outer;
    bool has_outer = false;
    std::size_t done = 0;
    for (const Day day : of_days) {
        const UtcTime next = std::min(UtcTime(day + days(1)), window.to.value_or(UtcTime::max()));
        UtcTime from = std::max(UtcTime(day), window.from.value_or(UtcTime(day)));
        for (std::size_t e = 0; e < epochs.size(); ++e) {
            // [from, to) is the epoch's part of the day.
            const UtcTime to = e + 1 < epochs.size() ? std::min(next, epochs[e + 1].start) : next;
            if (from >= to) continue;
            const RecordEpoch& epoch = epochs[e];
            const UtcTime begin = from;
            DayOfChannels samples;
            reading::on_all_cores(kChannels, [&](std::size_t k) {
                samples[k] =
                    archive::read_channel(archive, epoch.codes, epoch.scales.at(k).code, from, to);
            });
            for (const archive::ChannelData& channel : samples)
                reading::add_damage(record.warnings, channel);
            from = to;
            if (samples[kLeading].segments.empty()) continue;
            stream.use(epoch);
            stream.take(samples);
            if (!epoch.outer) continue;
            has_outer = true;
            const archive::ChannelData data =
                archive::read_channel(archive, epoch.codes, epoch.outer->code, begin, to);
            reading::add_damage(record.warnings, data);
            const auto course = reading::temperature_course(data.segments, *epoch.outer);
            outer.insert(outer.end(), course.begin(), course.end());
        }
        progress(++done, of_days.size());
    }
    stream.end_stretch();
    if (record.stretches.empty())
        throw InputError(fmt::format(
            "{}: archive: no sample of {}; allowed: an archive with samples from --from to --to",
            root.string(), epochs.back().scales[kLeading].code));
    if (has_outer) set_outer(record, outer);
    if (const auto position = position_of(metadata))
        remove_tide(record, *position);
    else
        record.warnings.push_back(
            text::message("{}: no position: the tide is not removed", metadata.string()));
    record.source = root;
    record.inputs.push_back(text::describe_input("metadata", metadata));
    describe_inputs(record, root, epochs, of_days);
    return record;
}

}  // namespace a351::corrector::long_record
