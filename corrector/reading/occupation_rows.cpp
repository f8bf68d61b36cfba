#include "corrector/reading/occupation_rows.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "corrector/archive_series/sample_grid.hpp"
#include "corrector/archive_series/samples.hpp"
#include "corrector/archive_series/wrong_profile.hpp"
#include "corrector/reading/moved_stay.hpp"
#include "corrector/reading/occupation_window.hpp"
#include "corrector/reading/refused.hpp"
#include "corrector/reading/start_up_findings.hpp"
#include "corrector/reading/stay_remarks.hpp"
#include "corrector/reading/vertical_axis.hpp"
#include "protocol/archive/journal_tail.hpp"
#include "protocol/core/sensor_limits.hpp"
#include "protocol/events/face.hpp"
#include "protocol/signal/decimator.hpp"

namespace a351::corrector::reading {
namespace {

using archive_series::Epoch, archive_series::kOuter, archive_series::kTemperature,
    archive_series::kVertical, archive_series::kWrongProfile, archive_series::last_sample;
using Samples = std::vector<archive::ChannelData>;

constexpr const char* kNoSamples = text::marked("no samples");
constexpr std::chrono::minutes kMargin(1);   // reach of the temperature's filters, 9 s, and more
constexpr std::chrono::hours kBefore(8);     // memory of the slowest response to temperature
constexpr std::chrono::hours kOuterLead(1);  // an earlier gap of the outer oven has little effect

/// Returns the time from the first window to the last, and that of the temperature before.  Nothing is
/// read after the end of an occupation that still runs.
archive_series::Span span_of(const std::vector<OccupationWindow>& windows, bool is_running) {
    return {windows.front().start - kMargin, windows.front().start - kBefore,
            windows.back().end + (is_running ? Nanoseconds(0) : Nanoseconds(kMargin))};
}

std::vector<text::InputFile> inputs_of(const SurveySource& source, const SurveyStays& stays) {
    std::vector<text::InputFile> inputs;
    const auto add = [&inputs](const char* role, const std::filesystem::path& file) {
        inputs.push_back(text::describe_input(role, file));
    };
    add("sites", source.sites);
    add("metadata", stays.metadata);
    if (!source.occupations.empty()) {
        add("occupations", source.occupations);
    } else {
        std::vector<std::filesystem::path> logs;
        for (const auto& entry : std::filesystem::directory_iterator(source.root / "events")) {
            if (entry.path().extension() == ".jsonl") logs.push_back(entry.path());
        }
        std::sort(logs.begin(), logs.end());
        for (const auto& log : logs) add("events", log);
    }
    if (!source.amendments.empty()) add("amendments", source.amendments);
    auto files =
        archive_series::files_of(source.root, stays.epoch, span_of(stays.list.windows, false));
    std::ranges::sort(files);
    for (const auto& file : files) add("archive", file);
    return inputs;
}

/// Returns the temperature from kBefore before the first occupation to the end of the last.
std::optional<DayTemperature> temperature_of_day(const Samples& samples, const Epoch& epoch,
                                                 const std::vector<OccupationWindow>& windows) {
    const auto& segments = samples[kTemperature].segments;
    if (segments.empty()) return std::nullopt;
    const auto grid =
        archive_series::sampling_grid(segments, segments.front().time_of(0), windows.back().end);
    if (!grid) return std::nullopt;
    const station::ChannelScale& scale = epoch.channels[kTemperature];
    const auto samples_on_grid = archive_series::number_on_grid(segments, *grid);
    signal::Decimator decimator(signal::design_decimation(kDecimationFactor), kDecimationStages);
    std::vector<double> block_degc, decimated_degc;
    for (std::size_t at = 0; at < grid->count; at += block_degc.size()) {
        block_degc.resize(std::min(archive_series::kBlockSamples, grid->count - at));
        archive_series::fill(block_degc, static_cast<std::int64_t>(at), samples_on_grid, scale.gain,
                             scale.offset);
        for (double& degc : block_degc)
            if (!is_temperature_believable(DegC(degc))) degc = std::nan("");
        decimator.push(block_degc, decimated_degc);
    }
    decimator.finish(decimated_degc);
    return day_temperature(
        TimeSeries<DegC>(grid->origin, Hertz(grid->rate_hz / kDecimationFactor / kDecimationFactor),
                         std::move(decimated_degc)));
}

/// Adds the temperature of an outer oven to the day, or a warning why it is not used.
void add_outer(DayRecord& day, const Samples& samples, const Epoch& epoch,
               const std::vector<OccupationWindow>& windows, std::vector<text::Message>& warnings) {
    if (!epoch.has_outer()) return;
    const auto course =
        archive_series::temperature_course(samples[kOuter].segments, epoch.channels[kOuter]);
    const TimeSeries<DegC>& grid = day.temperature.series;
    const UtcTime from = std::max(grid.start(), windows.front().start - kOuterLead);
    const UtcTime to = std::min(windows.back().end, last_sample(samples[kTemperature]));
    if (!archive_series::is_without_gaps(course, from, to)) {
        warnings.push_back(text::message(
            "the temperature of the outer oven is not used: it has a gap of more than 10 min"));
        return;
    }
    std::vector<UtcTime> times;
    for (std::size_t i = 0; i < grid.size(); ++i)
        times.push_back(grid.time_of(static_cast<double>(i)));
    day.outer = TimeSeries<DegC>(grid.start(), grid.rate(),
                                 archive_series::interpolated(course, times, Nanoseconds::max()));
}

/// The average of a set-up.
struct AveragedSetUp {
    OccupationWindow window;  ///< The given window, or the part of it in which the box stood.
    std::optional<Finding> moved = {};  ///< A move of the box; absent if there was none to name.
    /// Its value, with a temperature unless there is trouble.
    std::optional<RepresentativeValue> value = {};
    int face = 1;
    std::vector<DayBin> bins = {};
    std::string trouble = {};  ///< Reason why it has no row; empty if it has one.
};

AveragedSetUp average(const Samples& samples, const Epoch& epoch,
                      const std::vector<OccupationWindow>& windows, std::size_t i,
                      const RepresentativeOptions& options, bool is_tumbled) {
    const OccupationWindow& window = windows[i];
    AveragedSetUp set_up{window};
    auto record = cut_occupation(samples, epoch, window.start, window.end);
    if (!record) {
        set_up.trouble = kNoSamples;
        return set_up;
    }
    DecimatedAxes axes = decimate_axes(*record);
    if (auto moved = moved_stay(windows, i, *record, axes)) {
        set_up.window = std::move(moved->still);
        set_up.moved = std::move(moved->finding);
        record = cut_occupation(samples, epoch, set_up.window.start, set_up.window.end).value();
        axes = decimate_axes(*record);
    }
    set_up.value = representative_value(*record, axes, options);
    if (!set_up.value)
        set_up.trouble = text::marked("too few samples in a row");
    else if (!set_up.value->temperature)
        set_up.trouble = text::marked("no temperature");
    else if (!is_norm_believable(to_standard_gravity(set_up.value->curve_mean)) ||
             !is_temperature_believable(set_up.value->temperature->mean))
        set_up.trouble = kWrongProfile;
    // A tumble has no faces: it fits all axes.
    else if (const auto face = is_tumbled ? set_up.face : events::face_of(set_up.value->z.mean);
             !face)
        set_up.trouble = events::kOnItsSide;
    else {
        set_up.face = *face;
        set_up.bins = bin_set_up(0, axes, kDisturbanceThreshold);
        for (DayBin& bin : set_up.bins) bin.face = set_up.face;
    }
    return set_up;
}

/// Returns a set-up without trouble as a row of the survey, without tide.
SurveyRow row_of(const AveragedSetUp& set_up, const SurveyStays& stays) {
    const OccupationWindow& window = set_up.window;
    const RepresentativeValue& value = set_up.value.value();
    const TemperatureSummary& temperature = value.temperature.value();
    const text::Site& site = *text::find_site(stays.sites, window.site);
    SurveyRow row;
    static_cast<SetUp&>(row) = window;
    row.start = value.interval_start;
    row.end = value.interval_end;
    row.time = value.interval_start + (value.interval_end - value.interval_start) / 2;
    for (const OccupationFlag flag : value.flags) row.notes.emplace_back(flag_name(flag));
    row.acceleration = value.curve_mean;
    row.face = set_up.face;
    row.temperature = temperature.mean;
    row.rate_degc_per_h = temperature.slope_degc_per_h;
    row.record = static_cast<const RecordSummary&>(value);
    row.reference = site.gravity;
    row.u_reference = site.u_gravity;
    row.is_reference_refused =
        std::ranges::count(stays.amendments.refused_references, site.name) > 0;
    return row;
}

/// Ends a last stay without a stop at the last sample.
void end_with_record(std::vector<OccupationWindow>& windows, const archive::ChannelData& axis) {
    UtcTime end = UtcTime::min();
    for (const archive::Segment& segment : axis.segments)
        end = std::max(end, segment.time_of(segment.counts.size()));
    for (OccupationWindow& window : windows)
        if (window.is_last && end > window.start) window.end = std::min(window.end, end);
}

/// Adds the rows of the set-ups to the result, with their samples and findings; a set-up with trouble is
/// left out.
/// @return the windows of the rows.
std::vector<OccupationWindow> add_rows(OccupationRows& result, std::vector<AveragedSetUp>& set_ups,
                                       const std::vector<OccupationWindow>& windows,
                                       const SurveyStays& stays, bool is_tumbled) {
    std::vector<OccupationWindow> averaged;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        AveragedSetUp& set_up = set_ups[i];
        if (set_up.moved) result.findings.push_back(std::move(*set_up.moved));
        if (!set_up.trouble.empty()) {
            leave_out(result.left_out, result.warnings, windows[i], set_up.trouble);
            continue;
        }
        for (DayBin& bin : set_up.bins) {
            bin.set_up = result.rows.size();
            if (result.day && !result.day->temperature.is_bridged(bin.time))
                result.day->bins.push_back(std::move(bin));
        }
        if (auto finding = is_tumbled ? std::nullopt : other_face(windows[i], set_up.face))
            result.findings.push_back(std::move(*finding));
        result.rows.push_back(row_of(set_up, stays));
        result.records.push_back(std::move(*set_up.value));
        averaged.push_back(std::move(set_up.window));
    }
    return averaged;
}

/// Refuses a survey without a row.
[[noreturn]] void refuse_all(const SurveySource& source, const std::vector<AveragedSetUp>& set_ups,
                             const std::vector<text::Message>& warnings,
                             const std::vector<archive::AbsentFile>& absent) {
    const std::string origin = source.path.empty()
                                   ? source.root.string()
                                   : source.path.string() + ": root = " + source.root.string();
    if (std::ranges::find(set_ups, kWrongProfile, &AveragedSetUp::trouble) != set_ups.end())
        throw Refused("no_reading",
                      fmt::format("{}: no occupation can be used: {}", origin, kWrongProfile));
    const text::Message cause =
        absent.empty() ? warnings.back() : archive_series::to_message(absent.front());
    throw Refused(
        "no_reading",
        fmt::format(
            "{}: no occupation has samples: {}; allowed: an archive that covers these hours",
            origin, cause));
}

}  // namespace

OccupationRows average_occupations(const SurveySource& source, const SurveyStays& stays,
                                   const archive_series::Progress& progress) {
    const auto& [sites, list, amendments, metadata, epoch_of_file, units, findings] = stays;
    OccupationRows result;
    Epoch epoch = epoch_of_file;
    result.serial_number = epoch.serial_number;
    result.data_sheet_mgal_per_sqrt_hz = epoch.data_sheet_mgal_per_sqrt_hz;
    const bool is_running =
        !list.running_key.empty() && list.windows.back().key == list.running_key;
    const archive_series::Span span = span_of(list.windows, is_running);
    Samples samples = archive_series::read_samples(source.root, epoch, span);
    std::optional<UtcTime> journal_end;
    if (source.is_so_far)
        journal_end = archive_series::add_journaled(samples, source.root, epoch, span);
    std::vector<OccupationWindow> windows = list.windows;
    if (units.size() > 1)
        archive_series::keep_unit(
            samples, units, archive_series::span_at(units, windows.front().start).serial_number);
    end_with_record(windows, samples[kVertical]);
    text::Message mounting;
    if (source.is_tumbled)
        put_named_vertical_last(samples, epoch);
    else
        mounting = put_vertical_last(samples, epoch, windows, metadata);

    // The pieces of the whole day are first, because they are the longest.  One after the other, a day with
    // a linear model needs 1.05 times as long on two cores.
    std::vector<AveragedSetUp> set_ups(windows.size());
    std::optional<DayTemperature> temperature;
    std::vector<std::function<void()>> pieces{
        [&] { temperature = temperature_of_day(samples, epoch, windows); },
        [&] {
            result.temperature_course = archive_series::temperature_course(
                samples[kTemperature].segments, epoch.channels[kTemperature]);
        }};
    if (!source.is_so_far) pieces.emplace_back([&] { result.inputs = inputs_of(source, stays); });
    for (std::size_t i = 0; i < windows.size(); ++i)
        pieces.emplace_back([&, i] {
            set_ups[i] = average(samples, epoch, windows, i, source.averaging, source.is_tumbled);
        });
    archive_series::on_all_cores(
        pieces.size(), [&](std::size_t k) { pieces[k](); }, progress);

    if (temperature) result.day = DayRecord{std::move(*temperature), {}};
    result.left_out = list.left_out;
    result.warnings = list.warnings;
    if (result.day) add_outer(*result.day, samples, epoch, windows, result.warnings);
    if (!mounting.empty()) result.warnings.push_back(mounting);
    result.amendments = amendments;
    result.sites = sites;
    const auto absent = archive_series::absent_files(source.root, span.axes_from, span.to);
    for (const auto& one : absent) result.warnings.push_back(archive_series::to_message(one));
    for (const archive::ChannelData& channel : samples)
        archive_series::add_damage(result.warnings, channel);
    if (auto remark = archive_series::rate_remark(samples); !remark.empty())
        result.warnings.push_back(std::move(remark));
    const std::vector<OccupationWindow> averaged =
        add_rows(result, set_ups, windows, stays, source.is_tumbled);
    if (result.rows.empty()) refuse_all(source, set_ups, result.warnings, absent);
    std::size_t wanted = 0, without_samples = 0;
    for (const AveragedSetUp& set_up : set_ups) {
        if (set_up.window.is_excluded) continue;
        ++wanted;
        if (set_up.trouble == kNoSamples) ++without_samples;
    }
    auto unrecorded = mostly_without_samples(without_samples, wanted);
    if (unrecorded && !source.is_so_far) result.findings.push_back(std::move(*unrecorded));
    for (Finding& remark : stay_remarks(averaged, samples[kVertical]))
        result.findings.push_back(std::move(remark));
    result.findings.insert(result.findings.end(), findings.begin(), findings.end());
    std::ranges::stable_sort(result.left_out, {}, &LeftOut::start);
    for (text::Message& warning : position_warnings(result.rows, sites))
        result.warnings.push_back(std::move(warning));
    std::erase_if(result.temperature_course, [](const archive_series::MinuteTemperature& minute) {
        return !is_temperature_believable(minute.mean);
    });
    const auto events = events::read_events(source.root / "events").events;
    result.signal = signal_course(events, result.temperature_course);
    for (Finding& finding :
         start_up_findings(events, epoch.serial_number, windows.front().start, windows.back().end))
        result.findings.push_back(std::move(finding));
    result.running_key = list.running_key;
    if (!samples[kVertical].segments.empty()) result.data_end = last_sample(samples[kVertical]);
    if (source.is_so_far)
        result.as_of = is_running    ? source.running_until
                       : journal_end ? journal_end
                                     : archive::journal_end(source.root / "journal");
    return result;
}

}  // namespace a351::corrector::reading
