#include <functional>

#include "daemon/page/field_values.hpp"
#include "protocol/oven/controller_values.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using source::OvenLinkStatus;
using status::Status;
using text::marked;

bool has_sample(const Moment& now) { return now.status.last_sample.has_value(); }

/// Returns the function that gives a value of the status while there is a sample.
template <class Get>
auto of_sample(Get get) {
    return only_if(has_sample, get);
}

Fields device_fields() {
    const auto row = marked("device"), sampling = marked("sampling");
    return {
        {.path = "/device/product_id",
         .value = of(&Status::product_id),
         .meaning = "Product identifier that the sensor reports.",
         .shown = {row}},
        {.path = "/device/serial_number",
         .value = of(&Status::serial_number),
         .meaning = "Its serial number.",
         .shown = {row, marked("serial")}},
        {.path = "/device/start_up_test",
         .value = of(&Status::start_up_test),
         .meaning = "Result of its last start-up test: passed (no error was reported), HARD_ERR, "
                    "FLASH_ERR, or unknown if the answer was lost. An error remains until a later "
                    "test is passed."},
        {.path = "/device/state",
         .value = of(&Status::link_state),
         .meaning = "Connection: searching (for the port), handshake, sampling, waiting (before "
                    "the next try) or stopped.",
         .shown = {.row = row, .as = Shown::As::word}},
        {.path = "/device/port",
         .value = of(&Status::port),
         .meaning = "Port of the sensor.",
         .shown = {row}},
        {.path = "/device/trouble",
         .value = of(&Status::link_trouble),
         .meaning = "Why the sensor is not sampling.",
         .shown = {row}},
        {.path = "/device/output_rate_hz",
         .value = of(&Status::output_rate_hz),
         .meaning = "Configured rate.",
         .unit = "Hz",
         .shown = {sampling}},
        {.path = "/device/filter",
         .value = of(&Status::filter),
         .meaning = "Configured filter.",
         .shown = {sampling, marked("filter")}},
        {.path = "/device/profile",
         .value = of(&Status::profile),
         .meaning = "Profile of the sensor.",
         .shown = {sampling, marked("profile")}},
        {.path = "/device/profile_verified",
         .value = of(&Status::is_profile_verified),
         .meaning = "True if the profile is from the data sheet of this device.",
         .shown = {.row = sampling, .label = marked("not verified"), .as = Shown::As::denial}},
        {.path = "/device/assumed",
         .value = of(&Status::is_device_assumed),
         .meaning = "True if a running stream was continued and the device was not asked.",
         .shown = {sampling, marked("assumed as in the last session")}},
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
        {.path = "/sample",
         .value = null_without(has_sample),
         .meaning = "The last sample; null before the first one."},
        {.path = "/sample/acceleration_mg/0",
         .value = of_axis(0),
         .meaning = "Acceleration along x.",
         .unit = "mg",
         .shown = {marked("axes"), "x", 3}},
        {.path = "/sample/acceleration_mg/1",
         .value = of_axis(1),
         .meaning = "Acceleration along y.",
         .unit = "mg",
         .shown = {marked("axes"), "y", 3}},
        {.path = "/sample/acceleration_mg/2",
         .value = of_axis(2),
         .meaning = "Acceleration along z.",
         .unit = "mg",
         .shown = {marked("axes"), "z", 3}},
        {.path = "/sample/temperature_degc",
         .value = of_sample([](const Moment& now) { return now.status.temperature; }),
         .meaning = "Temperature of the sensor.",
         .unit = "degC",
         .shown = {.row = marked("temperature"), .decimals = 3},
         .metric = {.name = "a351_temperature_celsius",
                    .key = "at",
                    .label = "sensor",
                    .help = "Temperature of sensor and oven, and the oven's set point."}},
        {.path = "/sample/utc",
         .value = of_sample([](const Moment& now) { return *now.status.last_sample; }),
         .meaning = "Time of the last sample.",
         .shown = {last}},
        {.path = "/sample/age_s",
         .value = of_sample([](const Moment& now) {
             return seconds_between(*now.status.last_sample, now.status.now);
         }),
         .meaning = "Age of the last sample, instrument time.",
         .unit = "s",
         .shown = {last, marked("age"), 1},
         .metric = {.name = "a351_sample_age_seconds"}},
        {.path = "/received",
         .value = of(&Status::received),
         .meaning = "Index of the last sample of the session that was received.",
         .shown = {last, marked("index")},
         .metric = {.name = "a351_index", .key = "stage", .label = "received", .help = kStages}},
        {.path = "/journaled",
         .value = of(&Status::journaled),
         .meaning = "Index of the last one that survives a power cut.",
         .shown = {.row = marked("journal"), .as = Shown::As::index},
         .metric = {.name = "a351_index", .key = "stage", .label = "journaled"}},
        {.path = "/archived",
         .value = of(&Status::archived),
         .meaning = "Index of the last one in a synced record of the archive.",
         .shown = {.row = marked("archive"), .as = Shown::As::index},
         .metric = {.name = "a351_index", .key = "stage", .label = "archived"}},
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
        {.path = "/" + name + "/state",
         .value =
             [oven, is_inner](const Moment& now) {
                 const auto& status = now.status.*oven;
                 return status     ? json(source::to_text(status->state))
                        : is_inner ? json(marked("disabled"))
                                   : left_out();
             },
         .meaning =
             "Connection to the controller: searching, silent, disturbed or answering; disabled "
             "without one.",
         .shown = {.row = row, .as = Shown::As::word}},
        {.path = "/" + name + "/trouble",
         .value = of_oven(&OvenLinkStatus::trouble),
         .meaning = "Why the last poll was not answered.",
         .shown = {row}},
        {.path = "/" + name + "/port",
         .value = of_oven(&OvenLinkStatus::port),
         .meaning = "Port of the controller."},
        {.path = "/" + name + "/process_value_degc",
         .value = of_values(&Values::process_value),
         .meaning = "Temperature; not known if its probe has an error.",
         .unit = "degC",
         .shown = {row},
         .metric = {.name = "a351_temperature_celsius",
                    .key = "at",
                    .label = is_inner ? "oven" : "outer_oven"}},
        {.path = "/" + name + "/set_point_degc",
         .value = of_values(&Values::set_point),
         .meaning = "Set point.",
         .unit = "degC",
         .shown = {row, marked("set point")},
         .metric = {.name = "a351_temperature_celsius",
                    .key = "at",
                    .label = is_inner ? "set_point" : "outer_set_point"}},
        {.path = "/" + name + "/heating_percent",
         .value = of_values(&Values::heating),
         .meaning = "Heating power, as a part of full power.",
         .unit = "%",
         .shown = {row, marked("heating")},
         .metric = {.name = "a351_" + name + "_heating_ratio", .scale = 1e-2}},
        {.path = "/" + name + "/status_word",
         .value = of_values(&Values::status),
         .meaning = "Status word of the controller."},
        {.path = "/" + name + "/has_input_error",
         .value =
             of_values([](const Values& values) { return oven::has_input_error(values.status); }),
         .meaning = "True if the probe has an error.",
         .shown = {row, marked("input error")}},
        {.path = "/" + name + "/decimals",
         .value = of_oven(&OvenLinkStatus::decimals),
         .meaning = "Decimals of temperature and set point."},
        {.path = "/" + name + "/age_s",
         .value = of_oven(&OvenLinkStatus::age),
         .meaning = "Age of the last answer.",
         .unit = "s",
         .shown = {row, marked("age"), 1}},
        {.path = "/" + name + "/is_stale",
         .value = of_oven(&OvenLinkStatus::is_stale),
         .meaning = "True if it is older than three polls, or if there is none.",
         .shown = {row, marked("old")}},
        {.path = "/" + name + "/polls",
         .value = of_oven(source::polls_by_outcome),
         .meaning = "Polls of the controller, by outcome: answered, timed_out, bad_crc, exception, "
                    "other_unit, malformed, no_port.",
         .metric = {.name = "a351_" + name + "_polls_total",
                    .key = "outcome",
                    .as = Metric::As::items}},
    };
}

}  // namespace

Fields sensor_fields() {
    return concatenated({device_fields(), sample_fields(),
                         oven_fields("oven", &Status::oven, marked("oven")),
                         oven_fields("outer_oven", &Status::outer_oven, marked("outer oven"))});
}

}  // namespace a351::daemon::page
