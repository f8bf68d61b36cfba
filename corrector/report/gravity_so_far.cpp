#include "corrector/report/gravity_so_far.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "corrector/judgement/contradictions.hpp"
#include "corrector/judgement/reading_grade.hpp"
#include "corrector/result/joint_table.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::report {
namespace {

using Json = nlohmann::ordered_json;

/// Refusals that are usual in the field; the others keep their message.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kRefusals{{
    {"no_stay", text::marked("no stay was started")},
    {"no_metadata", text::marked("no data were recorded yet")},
    {"no_reading", text::marked("no stay has enough samples for a reading yet")},
    {"too_few_readings",
     text::marked("one reading alone cannot be corrected: read a second benchmark")},
    {"no_reference", text::marked("no benchmark with known gravity was read yet")},
}};

/// Findings that are left out: those on tasks that are still open in the day have no meaning before
/// its end, and the recorder itself reports that on the list of sites.
constexpr std::array kLeftOut{reading::FindingKind::not_visited,
                              reading::FindingKind::base_not_revisited,
                              reading::FindingKind::doubtful_site};

/// Reasons why a set-up has no value that are met as soon as it has samples.
constexpr std::array<std::string_view, 2> kJustBegun{"no samples", "too few samples in a row"};

/// A stay, and the places of its set-ups in the lists of the survey.
struct Stay {
    std::string key, site;
    int occupation = 1;
    UtcTime start;
    std::vector<std::size_t> rows, left_out;
};

std::vector<Stay> stays_of(const std::vector<reading::SurveyRow>& rows,
                           const std::vector<reading::LeftOut>& left_out) {
    std::vector<Stay> stays;
    const auto stay_of = [&](const std::string& key, const std::string& site, int occupation,
                             UtcTime start) -> Stay& {
        auto stay = std::ranges::find_if(stays, [&](const Stay& one) {
            return one.key == key && one.site == site && one.occupation == occupation;
        });
        if (stay == stays.end()) stay = stays.insert(stay, {key, site, occupation, start, {}, {}});
        stay->start = std::min(stay->start, start);
        return *stay;
    };
    for (std::size_t i = 0; i < rows.size(); ++i)
        stay_of(rows[i].key, rows[i].site, rows[i].occupation, rows[i].first_instant())
            .rows.push_back(i);
    for (std::size_t i = 0; i < left_out.size(); ++i)
        stay_of(left_out[i].key, left_out[i].site, left_out[i].occupation, left_out[i].start)
            .left_out.push_back(i);
    std::ranges::stable_sort(stays, {}, &Stay::start);
    return stays;
}

/// Returns what the mean of n of a station's N set-ups is uncertain by besides the station:
///
///     sqrt(s^2 (1/n - 1/N)),   u_set_up^2 = u_station^2 + s^2 (1 - 1/N)
///
/// with s the part that each set-up has alone: the placement, or the scatter of a linear model.
double own_part(double u_set_up, double u_station, std::size_t n, std::size_t count) {
    if (n >= count || u_set_up <= u_station) return 0.0;
    const double rest = 1.0 / static_cast<double>(count);
    return std::sqrt((u_set_up * u_set_up - u_station * u_station) *
                     (1.0 / static_cast<double>(n) - rest) / (1.0 - rest));
}

/// Sets the value of a stay with rows.  That of a known station does not use its own reference.
/// @param factor      of all uncertainties, while something contradicts.
/// @param is_named    the stay is one of those that contradict: its difference from the reference, or
///                    half of that between its set-ups, is a part of u.
void add_value(Json& json, const Stay& stay, const model::SurveyCorrection& result,
               std::optional<MilliGal> u_evening, double factor, bool is_named) {
    if (stay.rows.empty()) return;
    const model::StationValue* const station = result.station(stay.site);
    const auto& reference = result.rows[stay.rows.front()].row.reference;
    double sum = 0.0, least = HUGE_VAL, most = -HUGE_VAL;
    std::size_t known = 0;
    std::optional<double> u;
    for (const std::size_t i : stay.rows) {
        const model::CorrectedRow& row = result.rows[i];
        const auto* const day = row.as<model::WholeDayRow>();
        const auto value =
            !reference || day == nullptr ? std::optional(row.corrected) : day->left_out;
        if (value) ++known;
        sum += value.value_or(MilliGal(0.0)).value();
        least = std::min(least, row.corrected.value());
        most = std::max(most, row.corrected.value());
        if (row.u_corrected) u = std::max(u.value_or(0.0), row.u_corrected->value());
    }
    if (known < stay.rows.size()) {
        json["missing_parts"] =
            text::message("the only known benchmark so far: read a second one").to_json();
        return;
    }
    const double gravity = sum / static_cast<double>(stay.rows.size());
    if (u && station != nullptr && station->u_gravity) {
        // A misfit has enlarged that of the station, not those of the set-ups.
        const auto* const day = result.as<model::WholeDayPart>();
        const double misfit = day == nullptr ? 1.0 : day->uncertainty_factor;
        const double own = misfit * own_part(*u, station->u_gravity->value() / misfit,
                                             stay.rows.size(), station->row_count);
        u = std::hypot(u_evening.value_or(*station->u_gravity).value(), own);
    }
    json["gravity_mgal"] = gravity;
    const double off = reference ? gravity - reference->value() : 0.0;
    if (reference) json["left_out_difference_mgal"] = off;
    if (u)
        json["u_mgal"] =
            std::hypot(factor * *u, is_named ? std::max(std::abs(off), 0.5 * (most - least)) : 0.0);
}

constexpr auto kSize = [](double number) { return std::abs(number); };

/// @param is_running  its last set-up may have just begun: too few samples are no remark then.
Json remarks_of(const Stay& stay, const std::vector<judgement::ReadingGrade>& grades,
                const std::vector<reading::LeftOut>& left_out, bool is_running) {
    std::vector<judgement::Reason> reasons;
    // Set-ups of a stay differ little, so of reasons with numbers the largest is enough.
    const auto add = [&](const judgement::Reason& reason) {
        const auto same = std::ranges::find_if(reasons, [&](const judgement::Reason& other) {
            return other.code == reason.code &&
                   (!reason.numbers.empty() || other.text.english() == reason.text.english());
        });
        if (same == reasons.end())
            reasons.push_back(reason);
        else if (std::ranges::lexicographical_compare(same->numbers, reason.numbers, {}, kSize,
                                                      kSize))
            *same = reason;
    };
    for (const std::size_t i : stay.left_out) {
        const bool has_just_begun = is_running && i == stay.left_out.back() &&
                                    std::ranges::count(kJustBegun, left_out[i].reason) > 0;
        if (!has_just_begun) add({"left_out", {}, left_out[i].reason});
    }
    if (!grades.empty())
        for (const std::size_t i : stay.rows)
            for (const judgement::Reason& reason : grades[i].reasons) add(reason);
    Json remarks = Json::array();
    for (const judgement::Reason& reason : reasons)
        remarks.push_back({{"code", reason.code},
                           {"numbers", reason.numbers},
                           {"text", reason.text.english()},
                           {"text_parts", reason.text.to_json()}});
    return remarks;
}

/// Returns the rows as they were corrected, or else as they were read.
std::vector<reading::SurveyRow> rows_of(const GravitySoFar& so_far) {
    if (!so_far.result) return so_far.read ? so_far.read->rows : std::vector<reading::SurveyRow>();
    std::vector<reading::SurveyRow> rows;
    for (const model::CorrectedRow& row : so_far.result->rows) rows.push_back(row.row);
    return rows;
}

}  // namespace

std::string in_words(const reading::Refused& refused) {
    for (const auto& [code, text] : kRefusals)
        if (code == refused.code()) return std::string(text);
    return refused.what();
}

Json to_json(const GravitySoFar& so_far) {
    const auto instant = [](const std::optional<UtcTime>& time) {
        return time ? Json(to_rfc3339(*time, 3)) : Json(nullptr);
    };
    Json json;
    json["as_of_utc"] = instant(so_far.as_of);
    json["data_to_utc"] = instant(so_far.read ? so_far.read->data_end : std::nullopt);
    json["reason"] = text::or_null(so_far.reason);
    json["reason_text"] = text::or_null(so_far.reason_text);
    json["reason_parts"] = so_far.reason_text.empty()
                               ? Json(nullptr)
                               : Json(text::marked_message(so_far.reason_text).to_json());
    json["model"] = so_far.result ? Json(so_far.result->model) : Json(nullptr);
    json["stays"] = Json::array();
    std::vector<reading::LeftOut> left_out;
    if (so_far.read) left_out = so_far.result ? so_far.result->left_out : so_far.read->left_out;
    const auto grades = so_far.result ? judgement::grade_readings(*so_far.result)
                                      : std::vector<judgement::ReadingGrade>();
    const auto contradictions =
        so_far.result ? judgement::contradictions(*so_far.result, so_far.read->running_key)
                      : std::vector<judgement::Contradiction>();
    const double factor = contradictions.empty() ? 1.0 : judgement::doubt_factor(*so_far.result);
    for (const Stay& stay : stays_of(rows_of(so_far), left_out)) {
        Json one;
        one["key"] = text::or_null(stay.key);
        one["site"] = stay.site;
        one["occupation"] = stay.occupation;
        one["set_ups"] = stay.rows.size() + stay.left_out.size();
        for (const char* const name :
             {"gravity_mgal", "u_mgal", "left_out_difference_mgal", "missing_parts"})
            one[name] = nullptr;
        const bool is_running = !stay.key.empty() && stay.key == so_far.read->running_key;
        if (so_far.result)
            add_value(one, stay, *so_far.result,
                      is_running ? so_far.u_evening : std::optional<MilliGal>(), factor,
                      std::ranges::any_of(contradictions, [&](const auto& named) {
                          return reading::is_same_stay(named, stay);
                      }));
        else
            one["missing_parts"] = json["reason_parts"];
        one["is_running"] = is_running;
        one["remarks"] = remarks_of(stay, grades, left_out, is_running);
        json["stays"].push_back(std::move(one));
    }
    std::vector<reading::Finding> findings;
    if (so_far.read) findings = so_far.result ? so_far.result->findings : so_far.read->findings;
    // The signal says it of a stay that runs.
    const auto is_move_of_running = [&](const reading::Finding& finding) {
        return finding.kind == reading::FindingKind::moved_box && !finding.key.empty() &&
               finding.key == so_far.read->running_key;
    };
    std::erase_if(findings, [&](const reading::Finding& finding) {
        return std::ranges::count(kLeftOut, finding.kind) > 0 || is_move_of_running(finding);
    });
    json["findings"] = reading::findings_json(findings);
    for (const char* const name : {"contradictions", "lesser_contradictions"})
        json[name] = Json::array();
    for (const judgement::Contradiction& one : contradictions)
        json[one.is_lesser ? "lesser_contradictions" : "contradictions"].push_back(
            {{"code", one.code},
             {"key", one.key},
             {"site", one.site},
             {"occupation", one.occupation},
             {"text", one.text.english()},
             {"text_parts", one.text.to_json()}});
    return json;
}

}  // namespace a351::corrector::report
