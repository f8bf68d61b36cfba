#include "daemon/page/status_fields.hpp"

#include "daemon/page/field_values.hpp"
#include "daemon/page/status_json.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using status::Status;
using text::marked;

Fields general_fields() {
    return {
        {.path = "/level",
         .value = [](const Moment& now) { return to_text(now.status.level); },
         .meaning = "Level of the box: good, warning or fault.",
         .metric = {.name = "a351_level",
                    .key = "level",
                    .as = Metric::As::states,
                    .help = "1 for the present level, which is the exit status of a351ctl status.",
                    .states = {marked("good"), marked("warning"), marked("fault")}}},
        {.path = "/reasons",
         .value = of(&Status::reasons),
         .meaning = "Why the level is not good, see SENTENCES."},
        {.path = "/reason_parts",
         .value = [](const Moment& now) { return parts_of(now.status.reasons); },
         .meaning = "The same with their parts."},
        {.path = "/now",
         .value = of(&Status::now),
         .meaning = "Time of this status.",
         .shown = {marked("clock")}},
        {.path = "/host_now",
         .value = of(&Status::host_now),
         .meaning =
             "The same by the clock of the recorder's host: another one if an emulator sets the "
             "time."},
        {.path = "/session",
         .value =
             [](const Moment& now) {
                 return now.status.session.empty() ? json() : json(now.status.session);
             },
         .meaning = "Session of the sensor, null before the first one."},
        {.path = "/changes",
         .value = [](const Moment& now) { return now.occupations.changes(); },
         .meaning =
             "Number of changes of stays, notes, target and sites since the start: read the lists "
             "again when it differs."},
        {.path = "/live",
         .value = [](const Moment& now) { return channels_of(now.live); },
         .meaning =
             "The live stream: rate_hz, interval_s, and channels, each with name, unit, scale and "
             "offset (value = offset + scale x counts), see LIVE DATA."},
    };
}

}  // namespace

const Fields& status_fields() {
    static const Fields kFields =
        concatenated({general_fields(), operator_fields(), sensor_fields(), recorder_fields()});
    return kFields;
}

}  // namespace a351::daemon::page
