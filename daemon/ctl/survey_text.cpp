#include "daemon/ctl/survey_text.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/ctl/requests.hpp"
#include "daemon/ctl/screen.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {
namespace {

using nlohmann::json;

std::string word_of(const json& object, const char* key) {
    const auto value = object.find(key);
    return value != object.end() && value->is_string() ? printable(value->get<std::string>()) : "";
}

std::string mgal_of(const json& stay, const char* key) {
    const auto value = stay.find(key);
    return value != stay.end() && value->is_number() ? text::fixed(value->get<double>(), 2) : "-";
}

std::string stay_name(const json& stay) {
    return fmt::format("{} ({})", word_of(stay, "site"), stay.value("occupation", 0));
}

std::string state_of(const json& answer) {
    std::string state;
    if (const std::string reason = word_of(answer, "reason"); !reason.empty()) {
        const std::string cause = printable(sentence_of(answer, "reason_text", "reason_parts"));
        // The corrector's refusals are sentences with parts; the daemon's need their code.
        const bool is_sentence = !answer.value("reason_parts", json()).is_null();
        const std::string why = cause.empty() ? reason
                                : is_sentence ? cause
                                              : reason + ": " + cause;
        state = text::tr("no new figures: {}", why) + "\n";
    }
    const std::string as_of = word_of(answer, "as_of_utc"), to = word_of(answer, "data_to_utc");
    if (!as_of.empty())
        state += (to.empty() ? text::tr("as of {}, without data", as_of)
                             : text::tr("as of {}, data up to {}", as_of, to)) +
                 (answer.at("model").is_string() ? text::tr(", model {}", word_of(answer, "model"))
                                                 : "") +
                 "\n";
    return state;
}

}  // namespace

std::string survey_text(const json& answer) {
    std::string screen;
    for (const json& finding : answer.at("findings"))
        screen += fmt::format("{}{}\n", finding.value("is_headline", false) ? "! " : "  ",
                              printable(sentence_of(finding, "text", "text_parts")));
    if (answer.contains("contradictions"))
        for (const json& one : answer.at("contradictions"))
            screen += fmt::format("! {}\n", printable(sentence_of(one, "text", "text_parts")));
    std::vector<std::vector<std::string>> rows = {
        {"stay", "gravity_mgal", "u_mgal", "left_out_difference_mgal", "set_ups"}};
    std::string remarks;
    for (const json& stay : answer.at("stays")) {
        rows.push_back({stay_name(stay), mgal_of(stay, "gravity_mgal"), mgal_of(stay, "u_mgal"),
                        mgal_of(stay, "left_out_difference_mgal"),
                        std::to_string(stay.value("set_ups", 0))});
        if (stay.value("is_running", false))
            remarks += "  " + stay_name(stay) + ": " + text::tr("running") + "\n";
        if (stay.contains("missing_parts") && !stay.at("missing_parts").is_null())
            remarks += fmt::format(
                "  {}: {}\n", stay_name(stay),
                printable(text::in_words(text::parse_message(stay.at("missing_parts"), "-"))));
        for (const json& remark : stay.at("remarks"))
            remarks += fmt::format("  {}: {}\n", stay_name(stay),
                                   printable(sentence_of(remark, "text", "text_parts")));
    }
    if (rows.size() > 1) screen += text::aligned(rows);
    return screen + remarks + state_of(answer);
}

}  // namespace a351::daemon::ctl
