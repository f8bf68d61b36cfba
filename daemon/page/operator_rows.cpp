#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/page/status_rows.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using text::Message;

/// Returns a number with its unit; "-" if it is not known.
std::string number_of(const json& value, const char* format) {
    return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}

Row verdict_row(const json& verdict) {
    const auto state = verdict.at("state").get<std::string>();
    const json &held_s = verdict.at("held_s"), &left_s = verdict.at("time_left_s");
    Message text = text::marked_message(state);
    if (held_s.is_number()) text += text::message(" for {:.0f} s", held_s.get<double>());
    if (left_s.is_number() && left_s.get<double>() > 0.0)
        text += text::message(", at least {:.0f} s more", left_s.get<double>());
    if (const Message why = joined(verdict.at("reason_parts")); !why.empty())
        text += Message(": ") + why;
    return {text::marked("verdict"), text,
            state == "stable"    ? "good"
            : state == "no data" ? "fault"
                                 : "warning"};
}

Message stay_text(const json& stay) {
    Message text = text::message("{}, stay {}, since {} ({} s)", stay.at("site").get<std::string>(),
                                 stay.at("number").get<int>(), stay.at("start").get<std::string>(),
                                 number_of(stay.at("running_s"), "{:.0f}"));
    if (stay.at("set_up") != stay.at("start"))
        text += text::message(", set up {}", stay.at("set_up").get<std::string>());
    return text;
}

/// Returns where the stay is in its plan: "2 of 3: 2:10 left", or what to do when no time is left.
Message set_up_text(const json& stay) {
    const int running = stay.at("set_up_count").get<int>();
    const int planned = std::max(stay.at("planned_set_ups").get<int>(), running);
    const auto left = static_cast<int>(std::ceil(stay.at("set_up_left_s").get<double>()));
    Message text = text::message("{} of {}: ", running, planned);
    text += stay.at("may_stop") == true
                ? text::message("the stay may be stopped")
                : text::message("{} left", fmt::format("{}:{:02}", left / 60, left % 60));
    if (stay.at("propose_set_up") == true)
        text += text::message("; lift the box, set it down again, then run a351ctl setup");
    return text;
}

/// Returns the mean of all set-ups with their scatter.
Message reading_text(const json& reading) {
    Message text =
        text::message("{} +- {}, target {}", number_of(reading.at("value_mgal"), "{:.2f}"),
                      number_of(reading.at("standard_error_mgal"), "{:.2f} mGal"),
                      number_of(reading.at("target_mgal"), "{:.2f} mGal"));
    if (reading.at("is_good_enough") == true)
        text += text::message(": good enough");
    else if (const json& needed_s = reading.at("needed_s"); needed_s.is_number())
        text += text::message(": {:.0f} s more", needed_s.get<double>());
    if (reading.at("set_up_sd_mgal").is_number())
        text += text::message("; scatter of {} set-ups {}, of their mean {}",
                              reading.at("set_ups").get<int>(),
                              number_of(reading.at("set_up_sd_mgal"), "{:.2f} mGal"),
                              number_of(reading.at("set_up_error_mgal"), "{:.2f} mGal"));
    return text;
}

Message tilt_text(const json& tilt) {
    const Message advice = joined(tilt.at("advice_parts"));
    return text::message(
        "{} {}   {} {} compared with {}{}", tilt.at("axes").at(0).get<std::string>(),
        number_of(tilt.at("x_arcmin"), "{:+.1f}'"), tilt.at("axes").at(1).get<std::string>(),
        number_of(tilt.at("y_arcmin"), "{:+.1f}'"),
        tilt.at("reference").at("site").get<std::string>(),
        advice.empty() ? advice : Message(": ") + advice);
}

}  // namespace

std::vector<Row> operator_rows(const json& status) {
    std::vector<Row> rows{verdict_row(status.at("verdict"))};
    const json& stay = status.at("occupation");
    rows.push_back({text::marked("occupation"),
                    stay.is_null() ? text::message("none running") : stay_text(stay)});
    if (!stay.is_null()) {
        rows.push_back({text::marked("set-up"), set_up_text(stay)});
        rows.push_back({text::marked("reading"), reading_text(stay.at("whole"))});
        if (const Message warnings = joined(stay.at("warning_parts")); !warnings.empty())
            rows.push_back({text::marked("warnings"), warnings, "warning"});
    }
    if (const json& level = status.at("tilt"); !level.is_null())
        rows.push_back({text::marked("tilt"), tilt_text(level)});
    return rows;
}

}  // namespace a351::daemon::page
