#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
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

Row signal_row(const json& signal) {
    const auto word = signal.at("word").get<std::string>();
    const Message text =
        text::marked_message(signal.at("text").get<std::string>()) + Message(": ") +
        text::parse_message(signal.at("parts"), signal.at("sentence").get<std::string>());
    const bool is_wrong = word == "no_data" || word == "look";
    return {text::marked("signal"), text,
            is_wrong                                                ? "warning"
            : word == "go" && signal.at("buttons").at(0) != "start" ? "good"
                                                                    : ""};
}

/// Returns the commands of the terminal for the buttons of LOOK.
std::string commands_of(const json& signal, const json& stay) {
    const std::string at = stay.is_object() && stay.at("moved").is_object()
                               ? stay.at("moved").at("utc").get<std::string>()
                               : "";
    const std::string key = stay.is_object() ? stay.at("key").get<std::string>() : "";
    const std::map<std::string, std::string> commands{
        {"stop_at", "stop --at " + at},
        {"setup_at", "setup --at " + at},
        {"begin_at", "retime " + key + " --from " + at},
        {"not_moved", "not-moved"},
        {"setup", "setup"},
        {"checked", "checked"},
    };
    std::string text;
    const auto add = [&text](const std::string& command) {
        text += (text.empty() ? "a351ctl " : ", or a351ctl ") + command;
    };
    // A reading that does not fit the others may have a wrong name.
    if (const std::string named = signal.at("look").at("key");
        !named.empty() && signal.at("buttons") == json{"checked"} &&
        !signal.at("look").at("code").get<std::string>().starts_with("set_up"))
        add("rename " + named + " SITE");
    for (const json& button : signal.at("buttons")) add(commands.at(button));
    return text;
}

Message stay_text(const json& stay) {
    Message text = text::message("{}, stay {}, since {} ({} s)", stay.at("site").get<std::string>(),
                                 stay.at("number").get<int>(), stay.at("start").get<std::string>(),
                                 number_of(stay.at("running_s"), "{:.0f}"));
    if (stay.at("set_up") != stay.at("start"))
        text += text::message(", set up {}", stay.at("set_up").get<std::string>());
    return text;
}

/// Returns gravity with its uncertainty, or what is missing.
Message gravity_text(const json& gravity) {
    if (gravity.is_null()) return text::message("not computed yet");
    if (gravity.at("gravity_mgal").is_number())
        return {fmt::format("{} +- {} mGal", number_of(gravity.at("gravity_mgal"), "{:.1f}"),
                            number_of(gravity.at("u_mgal"), "{:.1f}"))};
    return text::parse_message(gravity.at("missing_parts"), "-");
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
    std::vector<Row> rows{signal_row(status.at("signal"))};
    const json& stay = status.at("occupation");
    const json& signal = status.at("signal");
    if (signal.at("word") == "look" && !signal.at("buttons").empty())
        rows.push_back({text::marked("commands"), commands_of(signal, stay)});
    rows.push_back({text::marked("occupation"),
                    stay.is_null() ? text::message("none running") : stay_text(stay)});
    if (!stay.is_null()) {
        rows.push_back({text::marked("gravity"), gravity_text(stay.at("gravity"))});
        if (const Message warnings = joined(stay.at("warning_parts")); !warnings.empty())
            rows.push_back({text::marked("warnings"), warnings, "warning"});
    }
    if (const json& level = status.at("tilt"); !level.is_null())
        rows.push_back({text::marked("tilt"), tilt_text(level)});
    return rows;
}

}  // namespace a351::daemon::page
