#include "corrector/judgement/reading_grade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/judgement/closure.hpp"
#include "corrector/judgement/physical_doubt.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "corrector/judgement/unlike_neighbours.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

void add(ReadingGrade& reading, Grade grade, Reason reason) {
    reading.grade = std::max(reading.grade, grade);
    reading.reasons.push_back(std::move(reason));
}

/// Adds that the operator or an amendment does not use the reading, or that it cannot be used.
/// @param uses_flags  the marks of the operator count.
void add_refusals(ReadingGrade& reading, const model::CorrectedRow& row, bool uses_flags) {
    if (row.row.is_flagged && !row.is_used && uses_flags)
        add(reading, Grade::repeat,
            {"flagged", {}, text::message("marked by the operator as not to be used")});
    for (const std::string& note : row.row.notes) {
        if (note == "excluded")
            add(reading, Grade::repeat, {note, {}, text::message("excluded by an amendment")});
        if (note == "shaken")
            add(reading, Grade::repeat, {note, {}, text::message("the box was never at rest")});
    }
}

/// Adds that a knock split the record.  The whole-day model uses both parts.
void add_knock(ReadingGrade& reading, const reading::SurveyRow& row) {
    if (row.has_note("pulse"))
        add(reading, Grade::care,
            {"pulse", {}, text::message("a knock split the record; its longest part was used")});
}

void add_temperature(ReadingGrade& reading, const model::CorrectedRow& row, bool corrects_rate) {
    std::string doubt = temperature_doubt(row.row);
    if (doubt.empty()) return;
    if (const auto at = doubt.find(';'); at != std::string::npos) doubt.replace(at, 1, ", ");
    add(reading, corrects_rate ? Grade::care : Grade::repeat,
        {"temperature_moving",
         {row.row.rate_degc_per_h, row.rate_correction.value()},
         corrects_rate
             ? text::message(
                   "temperature not steady: {}; the value depends on a rate correction of {} mGal",
                   doubt, text::fixed(row.rate_correction.value(), 1))
             : text::message("temperature not steady: {}, which the model does not correct",
                             doubt)});
}

/// Adds a reason if the residual is large.
/// @param is_left_out  u is that of the prediction without the row's station, not of the residual.
void add_residual(ReadingGrade& reading, const model::CorrectedRow& row, bool is_left_out) {
    if (!row.residual || !row.u_corrected || !(row.u_corrected->value() > 0.0)) return;
    if (row.row.is_reference_refused) return;  // it says nothing about the reading
    const double ratio = is_left_out ? row.studentised_residual.value_or(0.0)
                                     : row.residual->value() / row.u_corrected->value();
    if (std::abs(ratio) <= kCareRatio) return;
    const auto* const day = row.as<model::WholeDayRow>();
    const double off_mgal = is_left_out && day != nullptr && day->left_out && row.row.reference
                                ? (*day->left_out - *row.row.reference).value()
                                : ratio * row.u_corrected->value();
    add(reading, std::abs(ratio) > kRepeatRatio ? Grade::repeat : Grade::care,
        {"off_reference",
         {off_mgal, std::abs(ratio)},
         text::message(
             "{} mGal {}{}, {} times the uncertainty expected if name and reference are right",
             text::fixed(std::abs(off_mgal), text::decimals_for(row.u_corrected->value())),
             ratio > 0.0 ? text::message("above its reference")
                         : text::message("below its reference"),
             is_left_out ? text::message(" when its station is left out") : text::Message(),
             text::fixed(std::abs(ratio), 1))});
}

/// Adds the mistakes that concern the reading.  After a move of the box the value is that of the
/// part at rest, which is as good as any.
void add_findings(ReadingGrade& reading, const reading::SurveyRow& row,
                  const std::vector<reading::Finding>& findings) {
    for (const reading::Finding& finding : findings) {
        if (!reading::is_same_stay(finding, row)) continue;
        if (finding.kind == reading::FindingKind::moved_box || reading::is_remark(finding))
            continue;
        add(reading,
            finding.kind == reading::FindingKind::bad_reading ? Grade::repeat : Grade::care,
            {finding.code, {}, finding.text});
    }
}

/// Adds reasons if the samples alone say that the reading is worse than its uncertainty.
void add_samples(ReadingGrade& reading, const model::CorrectedRow& row) {
    if (!row.row.record || !row.u_corrected) return;
    const MilliGal u = *row.u_corrected, by_shaking = row.row.record->rectification;
    if (const auto error = row.row.record->standard_error; error && *error > u)
        add(reading, Grade::care,
            {"scattered",
             {error->value(), u.value()},
             text::message("its samples scatter: their mean is known to {} mGal only (u: {} mGal)",
                           text::fixed(error->value(), text::decimals_for(u.value())),
                           text::fixed(u.value(), text::decimals_for(u.value())))});
    if (by_shaking > u)
        add(reading, Grade::repeat,
            {"shaken",
             {by_shaking.value(), u.value()},
             text::message("the box was shaken as on a drive: this changes the norm of its samples "
                           "by {} mGal, more than its u of {} mGal",
                           text::fixed(by_shaking.value(), 1), text::fixed(u.value(), 1))});
}

/// Returns true if a mistake is named.  Then the residuals, which are those of the survey as entered,
/// blame good readings too; the search has judged every reading with the mistakes put right.
bool has_mistakes(const model::SurveyCorrection& result) {
    return std::ranges::any_of(result.findings, is_searched_mistake);
}

/// Scatter of readings of one station after all corrections.
struct ReadingScatter {
    text::Message name;
    double mgal = 0.0;
    /// The scatter divided by that stated; 0: readings have none of their own.
    double of_stated = 0.0;

    [[nodiscard]] double of(const model::CorrectedRow& row) const {
        return std::hypot(mgal, of_stated * row.row.u_average.value());
    }
};

std::optional<ReadingScatter> scatter_of(const model::SurveyCorrection& result) {
    if (result.as<model::WholeDayPart>() == nullptr) {
        if (!result.score.s_mgal) return std::nullopt;
        const bool is_network = result.as<model::NetworkPart>() != nullptr;
        return ReadingScatter{
            text::message("s"), *result.score.s_mgal,
            is_network ? *result.score.s_mgal / result.options.priors.reading_sd_mgal : 0.0};
    }
    // The readings are corrected for all other terms of this model.
    for (const model::Coefficient& coefficient : result.coefficients) {
        if (coefficient.name == "placement_mgal")
            return ReadingScatter{text::message("placement"), coefficient.value};
    }
    return std::nullopt;
}

/// The pair of readings of a station that differs most from what is expected.
struct WorstPair {
    std::size_t earlier = 0, later = 0, pair_count = 0;
    double difference_mgal = 0.0, expected_mgal = 0.0, ratio = 0.0;

    /// Returns true if such a pair is as rare among so many as a single one above kCareRatio.
    [[nodiscard]] bool is_rare() const {
        const auto share = [](double of) { return signal::chi_square_exceedance(1.0, of * of); };
        return static_cast<double>(pair_count) * share(ratio) < share(kCareRatio);
    }
};

/// Adds reasons to the two readings of each station that disagree most.  Readings to be repeated are
/// not compared.
void add_repeats(std::vector<ReadingGrade>& readings, const model::SurveyCorrection& result) {
    const auto scatter = scatter_of(result);
    if (!scatter || !(scatter->mgal > 0.0)) return;
    std::map<std::string, WorstPair> worst;
    for (const Closure& pair : close_stations(result)) {
        if (readings[pair.earlier].grade == Grade::repeat) continue;
        if (readings[pair.later].grade == Grade::repeat) continue;
        const model::CorrectedRow &a = result.rows[pair.earlier], &b = result.rows[pair.later];
        WorstPair& of = worst[a.row.site];
        ++of.pair_count;
        const double difference_mgal = std::abs(pair.after_all.value());
        const double expected_mgal = std::hypot(scatter->of(a), scatter->of(b));
        if (const double ratio = difference_mgal / expected_mgal; ratio > of.ratio)
            of = {pair.earlier, pair.later, of.pair_count, difference_mgal, expected_mgal, ratio};
    }
    for (const auto& [site, pair] : worst) {
        if (!pair.is_rare()) continue;
        const auto reason = [&](std::size_t other) {
            return Reason{
                "differs",
                {pair.difference_mgal, pair.ratio},
                text::message(
                    "differs by {} mGal from {}, {} times the value expected from {}",
                    text::fixed(pair.difference_mgal, text::decimals_for(pair.expected_mgal)),
                    reading_name(result.rows, other), text::fixed(pair.ratio, 1), scatter->name)};
        };
        add(readings[pair.earlier], Grade::care, reason(pair.later));
        add(readings[pair.later], Grade::care, reason(pair.earlier));
    }
}

/// Returns a doubt about the whole survey, for which no reading of it can be trusted; empty: none.
text::Message doubt_of_all(const model::SurveyCorrection& result) {
    const auto unusable = std::ranges::find(result.findings, reading::FindingKind::unusable_day,
                                            &reading::Finding::kind);
    if (unusable != result.findings.end()) return unusable->text;
    // A network of many readings fails with a scatter that the u shown contains already.
    constexpr double kMuchMore = 2.0;
    if (scatters_more_than_stated(result) &&
        result.as<model::NetworkPart>()->s0().value_or(0.0) > kMuchMore)
        return text::message("the readings scatter more than stated (global test failed)");
    return {};
}

}  // namespace

bool scatters_more_than_stated(const model::SurveyCorrection& result) {
    const auto* const network = result.as<model::NetworkPart>();
    return network != nullptr && network->scatters_more_than_stated();
}

std::string reason_text(const ReadingGrade& reading) {
    std::vector<std::string> texts;
    for (const Reason& reason : reading.reasons) texts.push_back(reason.text);
    return text::joined(texts, "; ");
}

std::string reason_in_words(const ReadingGrade& reading) {
    std::vector<text::Message> texts;
    for (const Reason& reason : reading.reasons) texts.push_back(reason.text);
    return text::in_words(texts, "; ");
}

std::string_view grade_name(Grade grade) noexcept {
    constexpr std::array<std::string_view, 3> kNames{text::marked("trust"), text::marked("care"),
                                                     text::marked("repeat")};
    return kNames[static_cast<std::size_t>(grade)];
}

std::optional<double> error_of(const model::CorrectedRow& row) {
    if (!row.residual) return std::nullopt;
    const auto* const day = row.as<model::WholeDayRow>();
    if (day == nullptr) return row.residual->value();
    if (!day->left_out) return std::nullopt;
    return (*day->left_out - *row.row.reference).value();
}

std::vector<ReadingGrade> grade_readings(const model::SurveyCorrection& result) {
    const bool corrects_rate = std::ranges::any_of(result.rows, [](const model::CorrectedRow& row) {
        return row.rate_correction != MilliGal(0.0);
    });
    const bool is_day = result.as<model::WholeDayPart>() != nullptr;
    const bool is_as_entered = !has_mistakes(result);
    std::vector<ReadingGrade> readings;
    for (const model::CorrectedRow& row : result.rows) {
        ReadingGrade& reading = readings.emplace_back();
        add_refusals(reading, row, result.options.use_flags);
        if (!is_day) {
            add_temperature(reading, row, corrects_rate);
            add_knock(reading, row.row);
        }
        if (is_as_entered) add_residual(reading, row, is_day);
        add_findings(reading, row.row, result.findings);
        add_samples(reading, row);
    }
    if (is_as_entered) add_repeats(readings, result);
    if (const text::Message doubt = doubt_of_all(result); !doubt.empty())
        for (ReadingGrade& reading : readings)
            add(reading, Grade::care, {kOfWholeSurvey, {}, doubt});
    return readings;
}

ReadingGrade grade_of_station(const model::SurveyCorrection& result,
                              const std::vector<ReadingGrade>& grades, const std::string& site) {
    ReadingGrade station{Grade::repeat, {}};
    for (std::size_t i = 0; i < grades.size(); ++i)
        if (result.rows[i].row.site == site)
            station.grade = std::min(station.grade, grades[i].grade);
    if (station.grade == Grade::trust) return station;
    for (std::size_t i = 0; i < grades.size(); ++i) {
        if (result.rows[i].row.site != site || grades[i].grade != station.grade) continue;
        text::Message name = reading_name(result.rows, i) + ": ";
        for (const Reason& reason : grades[i].reasons)
            station.reasons.push_back(
                {reason.code, reason.numbers, std::exchange(name, {}) + reason.text});
    }
    return station;
}

}  // namespace a351::corrector::judgement
