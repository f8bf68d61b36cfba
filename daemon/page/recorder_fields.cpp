#include <array>

#include "daemon/page/field_values.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using status::Status;
using text::marked;

double in_ms(Nanoseconds span) { return std::chrono::duration<double, std::milli>(span).count(); }

Fields timing_fields() {
    using timing::MeasuredRate;
    using Hours = std::chrono::duration<double, std::ratio<3600>>;
    const auto rate = marked("rate");
    return {
        {.path = "/timing/state",
         .value =
             [](const Moment& now) {
                 // In the order of the enumerators.
                 constexpr std::array kTexts{marked("unlocked"), marked("coarse"), marked("locked"),
                                             marked("holdover")};
                 return json(kTexts.at(static_cast<std::size_t>(now.status.timing_state)));
             },
         .meaning = "State of the sample times: unlocked, coarse, locked or holdover.",
         .shown = {.row = marked("timing"), .as = Shown::As::word}},
        {.path = "/timing/uncertainty_ms",
         .value = of(&Status::timing_uncertainty, in_ms),
         .meaning = "Uncertainty (95 %) of the time of the last sample.",
         .unit = "ms",
         .shown = {marked("timing"), marked("uncertainty"), 2},
         .metric = {.name = "a351_timing_uncertainty_seconds", .scale = 1e-3}},
        {.path = "/timing/host_uncertainty_ms",
         .value = of(&Status::host_uncertainty, in_ms),
         .meaning = "Its part that is the host's clock.",
         .unit = "ms",
         .shown = {marked("timing"), marked("of it the laptop's clock"), 2}},
        {.path = "/timing/clock_step",
         .value = of(&Status::clock_step,
                     [](const status::ClockStep& step) {
                         return json{{"utc", json_of(step.after)},
                                     {"clock_before", json_of(step.before)},
                                     {"by_s", seconds_between(step.before, step.after)}};
                     }),
         .meaning = "Newest step of the host's clock that the sample times followed: utc, "
                    "clock_before and by_s; or null."},
        {.path = "/timing/rate/declared_hz",
         .value = of(&Status::declared_rate_hz),
         .meaning = "Sample rate set in the configuration.",
         .unit = "Hz"},
        {.path = "/timing/rate/measured_hz",
         .value =
             of(&Status::measured_rate, [](const MeasuredRate& measured) { return measured.rate; }),
         .meaning = "Measured sample rate of the sensor.",
         .unit = "Hz",
         .shown = {.row = rate, .decimals = 6},
         .metric = {.name = "a351_measured_rate_hertz"}},
        {.path = "/timing/rate/uncertainty_ppm",
         .value = of(&Status::measured_rate, &MeasuredRate::uncertainty_ppm),
         .meaning = "Its uncertainty.",
         .unit = "ppm",
         .shown = {rate, marked("uncertainty"), 2}},
        {.path = "/timing/rate/span_h",
         .value = of(&Status::measured_rate,
                     [](const MeasuredRate& measured) { return Hours(measured.span).count(); }),
         .meaning = "Time over which it was measured.",
         .unit = "h",
         .shown = {rate, marked("over"), 1}},
        {.path = "/timing/rate/advice",
         .value = of(&Status::rate_advice),
         .meaning = "Advice on setting declared_rate_hz; may be empty."},
    };
}

json counters_of(const Moment& now) {
    const archive::Counters& c = now.status.counters;
    json counters = {{"bytes", c.bytes},
                     {"frames", c.frames},
                     {"bytes_skipped", c.bytes_skipped},
                     {"checksum_errors", c.checksum_errors},
                     {"framing_errors", c.framing_errors},
                     {"gaps", c.gaps},
                     {"samples_missing", c.samples_missing},
                     {"duplicates", c.duplicates},
                     {"anomalies", c.anomalies},
                     {"integer_records", c.integer_records},
                     {"error_flags", c.error_flags},
                     {"sessions", c.sessions},
                     {"records_withheld", c.records_withheld}};
    for (const auto& [key, count] : now.status.more_counters) counters[key] = count;
    return counters;
}

Fields store_fields() {
    const auto disk = marked("disk"), battery = marked("battery");
    const auto has_battery = [](const Moment& now) { return now.status.battery.has_value(); };
    return {
        {.path = "/counters",
         .value = counters_of,
         .meaning = "Counters since the daemon's start, by kind.",
         .shown = {.row = marked("troubles"), .as = Shown::As::counts},
         .metric = {.name = "a351_counter_total", .key = "kind", .as = Metric::As::items}},
        {.path = "/counters/archive_records_waiting",
         .value =
             [](const Moment& now) {
                 const auto& counters = now.status.more_counters;
                 const auto found = counters.find("archive_records_waiting");
                 return found == counters.end() ? left_out() : json(found->second);
             },
         .meaning = "Records that could not be written yet.",
         .metric = {.name = "a351_archive_records_waiting"}},
        {.path = "/disk/free_bytes",
         .value = of(&Status::disk_free_bytes),
         .meaning = "Free disk space for the recorded data.",
         .unit = "bytes",
         .shown = {disk, marked("free")},
         .metric = {.name = "a351_disk_free_bytes"}},
        {.path = "/disk/reserve",
         .value = of(&Status::disk_reserve),
         .meaning =
             "The reserve for a full disk: present, given_up (removed, or not created yet because "
             "space is short) or unavailable "
             "(the file system cannot reserve space; the log has the reason).",
         .shown = {.row = disk, .label = marked("reserve"), .as = Shown::As::word}},
        {.path = "/disk/longest_sync_ms",
         .value = [](const Moment& now) { return now.status.longest_sync.count(); },
         .meaning = "Longest time since the start that the journal waited for a write or sync, "
                    "including one in progress.",
         .unit = "ms",
         .shown = {disk, marked("longest sync")},
         .metric = {.name = "a351_longest_sync_seconds", .scale = 1e-3}},
        {.path = "/disk/written_bytes",
         .value = [](const Moment& now) { return now.status.disk_work.bytes; },
         .meaning =
             "Written to the disk since the start, in blocks of 4096 bytes, without what the file "
             "system adds.",
         .unit = "bytes",
         .metric = {.name = "a351_disk_written_bytes_total"}},
        {.path = "/disk/syncs",
         .value = [](const Moment& now) { return now.status.disk_work.syncs; },
         .meaning = "Syncs of files and directories since the start.",
         .metric = {.name = "a351_disk_syncs_total"}},
        {.path = "/disk/written_mb_an_hour",
         .value =
             of(&Status::hourly_disk_work,
                [](const files::DiskWork& work) { return static_cast<double>(work.bytes) / 1e6; }),
         .meaning = "Written in an hour, the mean since the start; null in the first minute.",
         .unit = "MB",
         .shown = {disk, marked("written in an hour"), 1}},
        {.path = "/disk/syncs_an_hour",
         .value = of(&Status::hourly_disk_work, &files::DiskWork::syncs),
         .meaning = "Syncs in an hour, likewise.",
         .shown = {disk, marked("syncs in an hour")}},
        {.path = "/battery",
         .value = null_without(has_battery),
         .meaning = "The battery of the computer; null if it has none."},
        {.path = "/battery/percent",
         .value =
             only_if(has_battery, [](const Moment& now) { return now.status.battery->percent; }),
         .meaning = "Its charge.",
         .unit = "%",
         .shown = {battery, {}, 0},
         .metric = {.name = "a351_battery_charge_ratio", .scale = 0.01}},
        {.path = "/battery/is_discharging",
         .value = only_if(has_battery,
                          [](const Moment& now) { return now.status.battery->is_discharging; }),
         .meaning = "True if it is not connected to a power supply.",
         .shown = {battery, marked("discharging")}},
        {.path = "/version",
         .value = of(&Status::version),
         .meaning = "Version of a351d.",
         .shown = {marked("version")},
         .metric = {.name = "a351_up",
                    .key = "version",
                    .as = Metric::As::text,
                    .help = "1 while the daemon answers."}},
        {.path = "/api",
         .value = [](const Moment&) { return kApiVersion; },
         .meaning = "Version of this interface; it rises when a field changes its meaning.",
         .shown = {marked("version"), marked("interface")}},
    };
}

}  // namespace

Fields recorder_fields() { return concatenated({timing_fields(), store_fields()}); }

}  // namespace a351::daemon::page
