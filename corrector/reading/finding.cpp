#include "corrector/reading/finding.hpp"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>

#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::reading {
namespace {

template <class Value>
nlohmann::ordered_json json_or_null(const Value& value, bool is_there) {
    if (!is_there) return nullptr;
    return value;
}

}  // namespace

std::string_view to_text(FindingKind kind) {
    // In the order of the enumerators.
    constexpr std::array<std::string_view, 15> kTexts{
        "moved_box",
        "other_name",
        "reference",
        "step",
        "bad_reading",
        "misfit",
        "unusable_day",
        "scale",
        "not_visited",
        "no_stop",
        "early_start",
        "missed_set_up",
        "short_stay",
        "base_not_revisited",
        "clock",
    };
    return kTexts.at(static_cast<std::size_t>(kind));
}

bool is_remark(const Finding& finding) { return finding.kind >= FindingKind::not_visited; }

std::string in_minutes(Nanoseconds time) {
    return fmt::format("{:.1f} min", std::chrono::duration<double, std::ratio<60>>(time).count());
}

void set_stay(Finding& finding, const std::string& site, int occupation, const std::string& key,
              UtcTime time) {
    finding.site = site;
    finding.occupation = occupation;
    finding.key = key;
    finding.time = time;
}

std::string amendment_head(std::string_view kind, const ListedSetUp& listed) {
    return fmt::format("[[{}]]\nsite = {}\noccupation = {}\n{}", kind,
                       text::toml_string(listed.site), listed.number,
                       listed.set_up ? fmt::format("set_up = {}\n", *listed.set_up) : "");
}

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
    auto list = nlohmann::ordered_json::array();
    for (const Finding& finding : findings) {
        nlohmann::ordered_json one;
        one["kind"] = to_text(finding.kind);
        one["code"] = finding.code;
        one["is_headline"] = finding.is_headline;
        one["site"] = json_or_null(finding.site, !finding.site.empty());
        one["occupation"] =
            json_or_null(finding.occupation.value_or(0), finding.occupation.has_value());
        one["key"] = json_or_null(finding.key, !finding.key.empty());
        one["time_utc"] = json_or_null(finding.time ? to_rfc3339(*finding.time, 3) : "",
                                       finding.time.has_value());
        one["size_mgal"] =
            json_or_null(finding.size_mgal.value_or(0.0), finding.size_mgal.has_value());
        one["u_mgal"] = json_or_null(finding.u_mgal.value_or(0.0), finding.u_mgal.has_value());
        one["other_site"] = json_or_null(finding.other_site, !finding.other_site.empty());
        one["text"] = finding.text.english();
        one["text_parts"] = finding.text.to_json();
        one["amendment"] = json_or_null(finding.amendment, !finding.amendment.empty());
        list.push_back(std::move(one));
    }
    return list;
}

std::string findings_text(const std::vector<Finding>& findings) {
    std::string text;
    for (std::size_t k = 0; k < findings.size(); ++k)
        text += fmt::format("  {}. {}\n", k + 1, text::in_words(findings[k].text));
    return text.empty() ? text : text::tr("found in this day:") + "\n" + text;
}

}  // namespace a351::corrector::reading
