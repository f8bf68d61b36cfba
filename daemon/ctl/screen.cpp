#include "daemon/ctl/screen.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/ctl/requests.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {
namespace {

using nlohmann::json;

/// Counters that also rise without trouble.
constexpr std::string_view kNoTrouble[] = {"bytes",
                                           "frames",
                                           "sessions",
                                           "link_sessions",
                                           "integer_records",
                                           "archive_records",
                                           "archive_records_waiting",
                                           "journal_bytes",
                                           "journal_segments_compressed",
                                           "journal_segments_removed"};

/// Returns the member at a path such as "device/port"; null if there is none.
const json& at(const json& object, const std::string& path) {
    static const json kNull;
    const json::json_pointer pointer("/" + path);
    return object.contains(pointer) ? object.at(pointer) : kNull;
}

std::string text_of(const json& value) {
    if (value.is_number_integer()) return value.dump();
    const std::string text =
        value.is_string() ? printable(value.get_ref<const std::string&>()) : "";
    return text.empty() ? "-" : text;
}
std::string text_of(const json& object, const std::string& path) {
    return text_of(at(object, path));
}

std::string number_of(const json& value, const char* format) {
    return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}
std::string number_of(const json& object, const std::string& path, const char* format) {
    return number_of(at(object, path), format);
}

/// Returns a word of a fixed list, such as the name of a state, in the language of this program.
std::string word_of(const json& object, const std::string& path) {
    return std::string(text::translated(text_of(object, path), text::language()));
}

std::string line(const std::string& name, const std::string& text) {
    return fmt::format("{:13}{}\n", name, text);
}

std::string coloured(const std::string& text, const std::string& level, bool is_coloured) {
    if (!is_coloured) return text;
    const char* code = level == "good" ? "32" : level == "warning" ? "33" : "31";
    return fmt::format("\x1b[1;{}m{}\x1b[0m", code, text);
}

/// Returns the index and its distance from the last sample received.
std::string lag(const json& status, const char* index) {
    const json& received = at(status, "received");
    const json& here = at(status, index);
    if (!received.is_number_integer() || !here.is_number_integer()) return "-";
    const auto samples = received.get<std::int64_t>() - here.get<std::int64_t>();
    const json& rate = at(status, "device/output_rate_hz");
    std::string text = text::tr("{}, {} behind", text_of(here), samples);
    if (rate.is_number() && rate.get<double>() > 0.0)
        text += fmt::format(" ({:.1f} s)", static_cast<double>(samples) / rate.get<double>());
    return text;
}

std::string axes(const json& status) {
    const json& values = at(status, "sample/acceleration_mg");
    if (!values.is_array() || values.size() != 3) return "-";
    return fmt::format("x {}   y {}   z {} mg", number_of(values[0], "{:.3f}"),
                       number_of(values[1], "{:.3f}"), number_of(values[2], "{:.3f}"));
}

/// Returns each counter of trouble that is not zero, with its name.
std::string troubles(const json& status) {
    std::string text;
    const json& counters = at(status, "counters");
    if (!counters.is_object()) return "-";
    for (const auto& [name, count] : counters.items()) {
        if (std::ranges::count(kNoTrouble, name) > 0) continue;
        if (!count.is_number_integer() || count == 0) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : "  ", printable(name), count.dump());
    }
    return text.empty() ? text::tr("none") : text;
}

std::string occupation(const json& status) {
    const json& running = at(status, "occupation");
    if (!running.is_object()) return text::tr("none running");
    std::string text = text::tr("{}, stay {}, since {} ({} s)", text_of(running, "site"),
                                text_of(running, "number"), text_of(running, "start"),
                                number_of(running, "running_s", "{:.0f}"));
    if (at(running, "set_up") != at(running, "start"))
        text += text::tr(", set up {}", text_of(running, "set_up"));
    return text;
}

std::string verdict(const json& status, bool is_coloured) {
    const std::string why = sentences_of(at(status, "verdict"), "reasons", "reason_parts");
    const json& held_s = at(status, "verdict/held_s");
    const json& left_s = at(status, "verdict/time_left_s");
    const bool is_waiting = left_s.is_number() && left_s.get<double>() > 0.0;
    const std::string state = text_of(status, "verdict/state");
    const char* const level = state == "stable" ? "good" : state == "no data" ? "fault" : "warning";
    return coloured(word_of(status, "verdict/state"), level, is_coloured) +
           (held_s.is_number() ? text::tr(" for {:.0f} s", held_s.get<double>()) : "") +
           (is_waiting ? text::tr(", at least {:.0f} s more", left_s.get<double>()) : "") +
           (why.empty() ? "" : ": " + why);
}

/// Returns where the stay is in its plan: "2 of 3: 2:10 left", or what to do when no time is left.
std::string set_up(const json& status) {
    const json& stay = at(status, "occupation");
    const json& left_s = at(stay, "set_up_left_s");
    if (!left_s.is_number()) return "-";
    const int running = stay.value("set_up_count", 1);
    const int planned = std::max(stay.value("planned_set_ups", 1), running);
    const auto left = static_cast<int>(std::ceil(left_s.get<double>()));
    const bool may_stop = at(stay, "may_stop") == true;
    std::string text = text::tr("{} of {}: ", running, planned);
    text += may_stop ? text::tr("the stay may be stopped")
                     : text::tr("{} left", fmt::format("{}:{:02}", left / 60, left % 60));
    if (at(stay, "propose_set_up") == true)
        text += text::tr("; lift the box, set it down again, then run a351ctl setup");
    return text;
}

/// Returns the mean of all set-ups with their scatter.
std::string reading(const json& status) {
    const json& reading = at(status, "occupation/whole");
    std::string text = text::tr("{} +- {}, target {}", number_of(reading, "value_mgal", "{:.2f}"),
                                number_of(reading, "standard_error_mgal", "{:.2f} mGal"),
                                number_of(status, "target_mgal", "{:.2f} mGal"));
    if (at(reading, "is_good_enough") == true)
        text += text::tr(": good enough");
    else if (const json& needed_s = at(reading, "needed_s"); needed_s.is_number())
        text += text::tr(": {:.0f} s more", needed_s.get<double>());
    if (at(reading, "set_up_sd_mgal").is_number())
        text +=
            text::tr("; scatter of {} set-ups {}, of their mean {}", text_of(reading, "set_ups"),
                     number_of(reading, "set_up_sd_mgal", "{:.2f} mGal"),
                     number_of(reading, "set_up_error_mgal", "{:.2f} mGal"));
    return text;
}

/// Returns the line of warnings on the running stay; empty if there are none.
std::string warnings(const json& status, bool is_coloured) {
    const std::string list = sentences_of(at(status, "occupation"), "warnings", "warning_parts");
    return list.empty() ? "" : line(text::tr("warnings"), coloured(list, "warning", is_coloured));
}

std::string tilt(const json& status) {
    const std::string advice = sentences_of(at(status, "tilt"), "advice", "advice_parts");
    return text::tr("{} {}   {} {} compared with {}{}", text_of(status, "tilt/axes/0"),
                    number_of(status, "tilt/x_arcmin", "{:+.1f}'"), text_of(status, "tilt/axes/1"),
                    number_of(status, "tilt/y_arcmin", "{:+.1f}'"),
                    text_of(status, "tilt/reference/site"), advice.empty() ? "" : ": " + advice);
}

std::string device(const json& status) {
    const auto trouble = text_of(status, "device/trouble");
    return text::tr("{} {}, {} on {}{}", text_of(status, "device/product_id"),
                    text_of(status, "device/serial_number"), word_of(status, "device/state"),
                    text_of(status, "device/port"), trouble == "-" ? "" : ": " + trouble);
}

std::string oven(const json& oven) {
    const std::string state = word_of(oven, "state");
    if (!at(oven, "age_s").is_number()) {
        const auto trouble = text_of(oven, "trouble");
        return trouble == "-" ? state : state + ": " + trouble;
    }
    const bool is_stale = at(oven, "is_stale") == true;
    return text::tr("{}, set point {}, heating {}{}, {}{}",
                    number_of(oven, "process_value_degc", "{:.1f} degC"),
                    number_of(oven, "set_point_degc", "{:.1f} degC"),
                    number_of(oven, "heating_percent", "{:.1f} %"),
                    at(oven, "has_input_error") == true ? text::tr(", input error") : "", state,
                    is_stale ? text::tr(", {:.0f} s old", at(oven, "age_s").get<double>()) : "");
}

/// Returns the lines of the ovens; a single oven has one.
std::string ovens(const json& status) {
    std::string lines = line(text::tr("oven"), oven(at(status, "oven")));
    if (at(status, "outer_oven").is_object())
        lines += line(text::tr("outer oven"), oven(at(status, "outer_oven")));
    return lines;
}

std::string timing(const json& status) {
    return text::tr("{}, uncertainty {}", word_of(status, "timing/state"),
                    number_of(status, "timing/uncertainty_ms", "{:.2f} ms"));
}

std::string disk(const json& status) {
    const json& free_bytes = at(status, "disk/free_bytes");
    const json free_gb = free_bytes.is_number() ? json(free_bytes.get<double>() / 1e9) : json();
    return text::tr("{} free", number_of(free_gb, "{:.1f} GB"));
}

std::string rate(const json& status) {
    const bool is_verified = at(status, "device/profile_verified") == true;
    return text::tr("{} Hz, filter {}, profile {}{}", text_of(status, "device/output_rate_hz"),
                    text_of(status, "device/filter"), text_of(status, "device/profile"),
                    is_verified ? "" : text::tr(" (not verified)"));
}

/// Formats rows as a table; each column is as wide as its widest cell.
std::string table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string shown;
        for (std::size_t i = 0; i < row.size(); ++i)
            shown += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
        text += shown.substr(0, shown.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        // U+0080 to U+009F are control characters too; in UTF-8 they begin with C2.
        const bool is_c1 = byte == 0xC2 && next >= 0x80 && next <= 0x9F;
        shown += byte < 0x20 || byte == 0x7F || is_c1 ? '?' : text[i];
        if (is_c1) ++i;
    }
    return shown;
}

std::string status_screen(const json& status, bool is_coloured) {
    const std::string level = text_of(status, "level");
    const std::string reasons = sentences_of(status, "reasons", "reason_parts");
    std::string screen = line(
        "a351d", fmt::format("{}   {}   {}{}", text_of(status, "version"), text_of(status, "now"),
                             coloured(word_of(status, "level"), level, is_coloured),
                             reasons.empty() ? "" : ": " + reasons));
    screen += line(text::tr("verdict"), verdict(status, is_coloured));
    screen += line(text::tr("occupation"), occupation(status));
    if (at(status, "occupation").is_object()) screen += line(text::tr("set-up"), set_up(status));
    if (at(status, "occupation/whole").is_object())
        screen += line(text::tr("reading"), reading(status));
    screen += warnings(status, is_coloured);
    if (at(status, "tilt").is_object()) screen += line(text::tr("tilt"), tilt(status));
    screen += line(text::tr("device"), device(status));
    screen += line(text::tr("sampling"), rate(status));
    screen += line(text::tr("axes"), axes(status));
    screen +=
        line(text::tr("temperature"), number_of(status, "sample/temperature_degc", "{:.3f} degC"));
    screen += ovens(status);
    screen +=
        line(text::tr("last sample"),
             text::tr("{} at {}, {}", text_of(status, "received"), text_of(status, "sample/utc"),
                      text::tr("{} ago", number_of(status, "sample/age_s", "{:.1f} s"))));
    screen += line(text::tr("journal"), lag(status, "journaled"));
    screen += line(text::tr("archive"), lag(status, "archived"));
    screen += line(text::tr("timing"), timing(status));
    if (at(status, "timing/rate/measured_hz").is_number()) {
        screen += line(
            text::tr("rate"),
            text::tr("{} +- {} over {}", number_of(status, "timing/rate/measured_hz", "{:.6f} Hz"),
                     number_of(status, "timing/rate/uncertainty_ppm", "{:.2f} ppm"),
                     number_of(status, "timing/rate/span_h", "{:.1f} h")));
    }
    screen += line(text::tr("counters"),
                   text::tr("frames {}  sessions {}", text_of(status, "counters/frames"),
                            text_of(status, "counters/sessions")));
    screen += line(text::tr("troubles"), troubles(status));
    screen += line(text::tr("disk"), disk(status));
    return screen;
}

std::string site_table(const json& answer) {
    std::vector<std::vector<std::string>> rows = {
        {"site", "longitude_deg", "latitude_deg", "altitude_m", "gravity_mgal", "distance_m"}};
    for (const auto& site : at(answer, "sites")) {
        rows.push_back(
            {text_of(site, "site"), number_of(site, "longitude_deg", "{:.6f}"),
             number_of(site, "latitude_deg", "{:.6f}"), number_of(site, "altitude_m", "{:.2f}"),
             number_of(site, "gravity_mgal", "{:.3f}"), number_of(site, "distance_m", "{:.0f}")});
    }
    return table(rows);
}

std::string occupation_table(const json& answer) {
    std::vector<std::vector<std::string>> rows = {{"site", "stay", "start", "end", "mgal",
                                                   "error_mgal", "sd_mgal", "key", "operator",
                                                   "note"}};
    const auto add = [&](const json& one, const std::string& number, std::string note) {
        const json& set_ups = at(one, "set_ups");
        const auto add_row = [&](const json& first, const json& last, const json& mean) {
            rows.push_back({text_of(one, "site"), number, text_of(first, "start"),
                            text_of(last, "end"), number_of(mean, "value_mgal", "{:.2f}"),
                            number_of(mean, "standard_error_mgal", "{:.2f}"), "-",
                            text_of(one, "key"), text_of(one, "operator"), note});
            note = "";
        };
        for (const auto& set_up : set_ups) add_row(set_up, set_up, at(set_up, "reading"));
        // The set-ups combined: the error is that of their own scatter.
        if (!at(one, "reading/set_up_sd_mgal").is_number()) return;
        const json& mean = at(one, "reading");
        add_row(set_ups.front(), set_ups.back(), mean);
        rows.back()[1] += text::tr(" mean");
        rows.back()[5] = number_of(mean, "set_up_error_mgal", "{:.2f}");
        rows.back()[6] = number_of(mean, "set_up_sd_mgal", "{:.2f}");
    };
    for (const auto& one : at(answer, "occupations"))
        add(one, text_of(one, "number"), text_of(one, "note"));
    for (const auto& one : at(answer, "discarded")) add(one, "-", text::tr("discarded"));
    return table(rows);
}

int plugin_status(const json& status) {
    const json& level = at(status, "level");
    return level == "good" ? 0 : level == "warning" ? 1 : level == "fault" ? 2 : 3;
}

}  // namespace a351::daemon::ctl
