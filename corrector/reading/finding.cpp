#include "corrector/reading/finding.hpp"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>

#include "protocol/text/or_null.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::reading {
std::string_view to_text(FindingKind kind) {
    // In the order of the enumerators.
    constexpr auto kTexts = std::to_array<std::string_view>(
        {"moved_box",          "other_name",    "reference",    "step",
         "bad_reading",        "misfit",        "unusable_day", "scale",
         "start_up_test",      "turned",        "not_visited",  "no_stop",
         "early_start",        "missed_set_up", "not_lifted",   "short_stay",
         "base_not_revisited", "doubtful_site", "clock",        "other_unit"});
    return kTexts.at(static_cast<std::size_t>(kind));
}

bool is_remark(const Finding& finding) { return finding.kind >= FindingKind::not_visited; }

bool is_mistake(const Finding& finding) {
    return finding.kind == FindingKind::other_name || finding.kind == FindingKind::reference ||
           finding.kind == FindingKind::step || finding.kind == FindingKind::bad_reading;
}

std::string in_minutes(Nanoseconds time) {
    return fmt::format("{:.1f} min", std::chrono::duration<double, std::ratio<60>>(time).count());
}

void set_stay(Finding& finding, const SetUp& set_up, UtcTime time) {
    finding.site = set_up.site;
    finding.occupation = set_up.occupation;
    finding.key = set_up.key;
    finding.time = time;
}

void set_stay(Finding& finding, const SurveyRow& row) {
    set_stay(finding, row, row.first_instant());
}

std::string amendment_head(std::string_view kind, const ListedSetUp& listed) {
    return fmt::format("[[{}]]\nsite = {}\noccupation = {}\n{}", kind,
                       text::toml_string(listed.site), listed.number,
                       listed.set_up ? fmt::format("set_up = {}\n", *listed.set_up) : "");
}

std::string rename_amendment(const SetUp& set_up, const std::string& to,
                             const std::string& reason) {
    if (set_up.listed.site.empty()) return {};
    ListedSetUp stay = set_up.listed;
    stay.set_up.reset();
    return amendment_head("rename", stay) +
           fmt::format("to = {}\nreason = {}\n", text::toml_string(to), text::toml_string(reason));
}

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
    auto list = nlohmann::ordered_json::array();
    for (const Finding& finding : findings) {
        const auto time = finding.time ? to_rfc3339(*finding.time, 3) : "";
        list.push_back({{"kind", to_text(finding.kind)},
                        {"code", finding.code},
                        {"is_headline", finding.is_headline},
                        {"site", text::or_null(finding.site)},
                        {"occupation", text::or_null(finding.occupation)},
                        {"key", text::or_null(finding.key)},
                        {"time_utc", text::or_null(time)},
                        {"size_mgal", text::or_null(finding.size_mgal)},
                        {"u_mgal", text::or_null(finding.u_mgal)},
                        {"other_site", text::or_null(finding.other_site)},
                        {"text", finding.text.english()},
                        {"text_parts", finding.text.to_json()},
                        {"amendment", text::or_null(finding.amendment)}});
    }
    return list;
}

}  // namespace a351::corrector::reading
