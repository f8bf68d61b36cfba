#include <array>
#include <functional>

#include "daemon/page/field_values.hpp"
#include "protocol/oven/controller_values.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using source::OvenLinkStatus;
using status::Status;
using text::marked;
using Fields = std::vector<Field>;

constexpr auto kAll = Shown::kAllDecimals;

bool has_sample(const Moment& now) { return now.status.last_sample.has_value(); }

/// Returns the function that gives a value of the status while there is a sample.
template <class Get>
auto of_sample(Get get) {
    return only_if(has_sample, get);
}

Fields device_fields() {
    const auto row = marked("device"), sampling = marked("sampling");
    return {
        {"/device/product_id",
         of(&Status::product_id),
         "Product identifier that the sensor reports.",
         {},
         {row}},
        {"/device/serial_number",
         of(&Status::serial_number),
         "Its serial number.",
         {},
         {row, marked("serial")}},
        {"/device/state",
         of(&Status::link_state),
         "Connection: searching (for the port), handshake, sampling, waiting (before the next try) "
         "or stopped.",
         {},
         {row, {}, kAll, Shown::As::word}},
        {"/device/port", of(&Status::port), "Port of the sensor.", {}, {row}},
        {"/device/trouble",
         of(&Status::link_trouble),
         "Why the sensor is not sampling.",
         {},
         {row}},
        {"/device/output_rate_hz",
         of(&Status::output_rate_hz),
         "Configured rate.",
         "Hz",
         {sampling}},
        {"/device/filter",
         of(&Status::filter),
         "Configured filter.",
         {},
         {sampling, marked("filter")}},
        {"/device/profile",
         of(&Status::profile),
         "Profile of the sensor.",
         {},
         {sampling, marked("profile")}},
        {"/device/profile_verified",
         of(&Status::is_profile_verified),
         "True if the profile is from the data sheet of this device.",
         {},
         {sampling, marked("not verified"), kAll, Shown::As::denial}},
        {"/device/assumed",
         of(&Status::is_device_assumed),
         "True if a running stream was continued and the device was not asked.",
         {},
         {sampling, marked("assumed as in the last session")}},
    };
}

Fields sample_fields() {
    const auto last = marked("last sample");
    const auto of_axis = [](std::size_t axis) {
        return of_sample(
            [axis](const Moment& now) { return 1e3 * now.status.acceleration[axis].value(); });
    };
    constexpr std::string_view kStages =
        "Index of the last sample of the session that was received, journaled, archived.";
    return {
        {"/sample", null_without(has_sample), "The last sample; null before the first one."},
        {"/sample/acceleration_mg/0",
         of_axis(0),
         "Acceleration along x.",
         "mg",
         {marked("axes"), "x", 3}},
        {"/sample/acceleration_mg/1",
         of_axis(1),
         "Acceleration along y.",
         "mg",
         {marked("axes"), "y", 3}},
        {"/sample/acceleration_mg/2",
         of_axis(2),
         "Acceleration along z.",
         "mg",
         {marked("axes"), "z", 3}},
        {"/sample/temperature_degc",
         of_sample([](const Moment& now) { return now.status.temperature; }),
         "Temperature of the sensor.",
         "degC",
         {marked("temperature"), {}, 3},
         {.name = "a351_temperature_celsius",
          .key = "at",
          .label = "sensor",
          .help = "Temperature of sensor and oven, and the oven's set point."}},
        {"/sample/utc",
         of_sample([](const Moment& now) { return *now.status.last_sample; }),
         "Time of the last sample.",
         {},
         {last}},
        {"/sample/age_s",
         of_sample([](const Moment& now) {
             return seconds_between(*now.status.last_sample, now.status.now);
         }),
         "Age of the last sample, instrument time.",
         "s",
         {last, marked("age"), 1},
         {.name = "a351_sample_age_seconds"}},
        {"/received",
         of(&Status::received),
         "Index of the last sample of the session that was received.",
         {},
         {last, marked("index")},
         {.name = "a351_index", .key = "stage", .label = "received", .help = kStages}},
        {"/journaled",
         of(&Status::journaled),
         "Index of the last one that survives a power cut.",
         {},
         {marked("journal"), {}, kAll, Shown::As::index},
         {.name = "a351_index", .key = "stage", .label = "journaled"}},
        {"/archived",
         of(&Status::archived),
         "Index of the last one in a synced record of the archive.",
         {},
         {marked("archive"), {}, kAll, Shown::As::index},
         {.name = "a351_index", .key = "stage", .label = "archived"}},
    };
}

/// Returns the fields of an oven.
/// @param name   key of the table, and part of the metrics' names.
Fields oven_fields(const std::string& name, std::optional<OvenLinkStatus> Status::*oven,
                   std::string_view row) {
    const auto of_oven = [oven](auto get) {
        return only_if([oven](const Moment& now) { return (now.status.*oven).has_value(); },
                       [oven, get](const Moment& now) {
                           return json_of(std::invoke(get, *(now.status.*oven)));
                       });
    };
    const auto of_values = [of_oven](auto get) {
        return of_oven([get](const OvenLinkStatus& status) {
            return status.values ? json_of(std::invoke(get, *status.values)) : json();
        });
    };
    const bool is_inner = name == "oven";
    using Values = oven::ControllerValues;
    return {
        {"/" + name + "/state",
         [oven, is_inner](const Moment& now) {
             const auto& status = now.status.*oven;
             return status     ? json(source::to_text(status->state))
                    : is_inner ? json(marked("disabled"))
                               : left_out();
         },
         "Connection to the controller: searching, silent, disturbed or answering; disabled "
         "without one.",
         {},
         {row, {}, kAll, Shown::As::word}},
        {"/" + name + "/trouble",
         of_oven(&OvenLinkStatus::trouble),
         "Why the last poll was not answered.",
         {},
         {row}},
        {"/" + name + "/port", of_oven(&OvenLinkStatus::port), "Port of the controller."},
        {"/" + name + "/process_value_degc",
         of_values(&Values::process_value),
         "Temperature; not known if its probe has an error.",
         "degC",
         {row},
         {.name = "a351_temperature_celsius",
          .key = "at",
          .label = is_inner ? "oven" : "outer_oven"}},
        {"/" + name + "/set_point_degc",
         of_values(&Values::set_point),
         "Set point.",
         "degC",
         {row, marked("set point")},
         {.name = "a351_temperature_celsius",
          .key = "at",
          .label = is_inner ? "set_point" : "outer_set_point"}},
        {"/" + name + "/heating_percent",
         of_values(&Values::heating),
         "Heating power, as a part of full power.",
         "%",
         {row, marked("heating")},
         {.name = "a351_" + name + "_heating_ratio", .scale = 1e-2}},
        {"/" + name + "/status_word", of_values(&Values::status), "Status word of the controller."},
        {"/" + name + "/has_input_error",
         of_values([](const Values& values) { return oven::has_input_error(values.status); }),
         "True if the probe has an error.",
         {},
         {row, marked("input error")}},
        {"/" + name + "/decimals", of_oven(&OvenLinkStatus::decimals),
         "Decimals of temperature and set point."},
        {"/" + name + "/age_s",
         of_oven(&OvenLinkStatus::age),
         "Age of the last answer.",
         "s",
         {row, marked("age"), 1}},
        {"/" + name + "/is_stale",
         of_oven(&OvenLinkStatus::is_stale),
         "True if it is older than three polls, or if there is none.",
         {},
         {row, marked("old")}},
        {"/" + name + "/polls",
         of_oven(source::polls_by_outcome),
         "Polls of the controller, by outcome.",
         {},
         {},
         {.name = "a351_" + name + "_polls_total", .key = "outcome", .as = Metric::As::items}},
    };
}

Fields timing_fields() {
    using timing::MeasuredRate;
    using Hours = std::chrono::duration<double, std::ratio<3600>>;
    const auto rate = marked("rate");
    return {
        {"/timing/state",
         [](const Moment& now) {
             // In the order of the enumerators.
             constexpr std::array kTexts{marked("unlocked"), marked("coarse"), marked("locked"),
                                         marked("holdover")};
             return json(kTexts.at(static_cast<std::size_t>(now.status.timing_state)));
         },
         "State of the sample times: unlocked, coarse, locked or holdover.",
         {},
         {marked("timing"), {}, kAll, Shown::As::word}},
        {"/timing/uncertainty_ms",
         of(&Status::timing_uncertainty,
            [](Nanoseconds span) {
                return std::chrono::duration<double, std::milli>(span).count();
            }),
         "Uncertainty (95 %) of the time of the last sample.",
         "ms",
         {marked("timing"), marked("uncertainty"), 2},
         {.name = "a351_timing_uncertainty_seconds", .scale = 1e-3}},
        {"/timing/clock_step",
         of(&Status::clock_step,
            [](const status::ClockStep& step) {
                return json{{"utc", json_of(step.after)},
                            {"clock_before", json_of(step.before)},
                            {"by_s", seconds_between(step.before, step.after)}};
            }),
         "Newest step of the host's clock that the sample times followed: utc, clock_before and "
         "by_s; or null."},
        {"/timing/rate/declared_hz", of(&Status::declared_rate_hz),
         "Sample rate set in the configuration.", "Hz"},
        {"/timing/rate/measured_hz",
         of(&Status::measured_rate, [](const MeasuredRate& measured) { return measured.rate; }),
         "Measured sample rate of the sensor.",
         "Hz",
         {rate, {}, 6},
         {.name = "a351_measured_rate_hertz"}},
        {"/timing/rate/uncertainty_ppm",
         of(&Status::measured_rate, &MeasuredRate::uncertainty_ppm),
         "Its uncertainty.",
         "ppm",
         {rate, marked("uncertainty"), 2}},
        {"/timing/rate/span_h",
         of(&Status::measured_rate,
            [](const MeasuredRate& measured) { return Hours(measured.span).count(); }),
         "Time over which it was measured.",
         "h",
         {rate, marked("over"), 1}},
        {"/timing/rate/advice", of(&Status::rate_advice),
         "Advice on setting declared_rate_hz; may be empty."},
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
    const auto disk = marked("disk");
    return {
        {"/counters",
         counters_of,
         "Counters since the daemon's start, by kind.",
         {},
         {marked("troubles"), {}, kAll, Shown::As::counts},
         {.name = "a351_counter_total", .key = "kind", .as = Metric::As::items}},
        {"/counters/archive_records_waiting",
         [](const Moment& now) {
             const auto& counters = now.status.more_counters;
             const auto found = counters.find("archive_records_waiting");
             return found == counters.end() ? left_out() : json(found->second);
         },
         "Records that could not be written yet.",
         {},
         {},
         {.name = "a351_archive_records_waiting"}},
        {"/disk/free_bytes",
         of(&Status::disk_free_bytes),
         "Free disk space for the recorded data.",
         "bytes",
         {disk, marked("free")},
         {.name = "a351_disk_free_bytes"}},
        {"/disk/reserve",
         of(&Status::disk_reserve),
         "The reserve for a full disk: present, given_up (removed, or not created yet because "
         "space is short) or unavailable "
         "(the file system cannot reserve space; the log has the reason).",
         {},
         {disk, marked("reserve"), kAll, Shown::As::word}},
        {"/disk/longest_sync_ms",
         [](const Moment& now) { return now.status.longest_sync.count(); },
         "Longest time since the start that the journal waited for a write or sync, including one "
         "in progress.",
         "ms",
         {disk, marked("longest sync")},
         {.name = "a351_longest_sync_seconds", .scale = 1e-3}},
        {"/version",
         of(&Status::version),
         "Version of a351d.",
         {},
         {marked("version")},
         {.name = "a351_up",
          .key = "version",
          .as = Metric::As::text,
          .help = "1 while the daemon answers."}},
        {"/api",
         [](const Moment&) { return kApiVersion; },
         "Version of this interface; it rises when a field changes its meaning.",
         {},
         {marked("version"), marked("interface")}},
    };
}

}  // namespace

Fields recorder_fields() {
    return joined({device_fields(), sample_fields(),
                   oven_fields("oven", &Status::oven, marked("oven")),
                   oven_fields("outer_oven", &Status::outer_oven, marked("outer oven")),
                   timing_fields(), store_fields()});
}

}  // namespace a351::daemon::page
