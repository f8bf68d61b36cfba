#include "corrector/report/reading_grade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "corrector/figure/reading_name.hpp"
#include "corrector/model/outlier_tests.hpp"
#include "corrector/report/closure.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

// |error| / u: of Gaussian errors one in 22 lies above the first, one in 370 above the other.
constexpr double kCareRatio = 2.0;
constexpr double kRepeatRatio = 3.0;

// Between the two trends of one record: a quarter of the 2 mGal that good readings scatter by.
constexpr double kTrendDifference_mgal = 0.5;

void add(ReadingGrade& reading, Grade grade, std::string reason) {
    reading.grade = std::max(reading.grade, grade);
    reading.reasons.push_back(std::move(reason));
}

struct NoteText {
    std::string_view note;
    Grade grade;
    std::string_view text;
};
/// The doubts of representative_value.hpp, and amendments, in words.
constexpr std::array<NoteText, 11> kNoteTexts{{
    {"fallback", Grade::care,
     "the interval could not be chosen by its first rule (fallback): look at the record"},
    {"disturbed_start", Grade::trust, "averaged from after a disturbance at its start"},
    {"disturbed_end", Grade::trust, "averaged up to a disturbance at its end"},
    {"pulse", Grade::care, "a knock cut the record; its longer part was used"},
    {"gap", Grade::care, "samples are missing"},
    {"no-stop", Grade::care, "not stopped: it lasts to the next start, the way there included"},
    {"unsettled", Grade::care, "the weights of the smoother did not settle"},
    {"excluded", Grade::repeat, "excluded by an amendment"},
    {"included", Grade::trust, "included by an amendment"},
    {"retimed", Grade::trust, "its times were amended"},
    {"renamed", Grade::trust, "its site was amended"},
}};

/// Of the trend and its interval.
constexpr std::array<std::string_view, 4> kTrendNotes{"fallback", "disturbed_start",
                                                      "disturbed_end", "unsettled"};

/// @param is_day  the trend is not what the model averages.
void add_note(ReadingGrade& reading, const std::string& note, bool is_day) {
    if (is_day && std::find(kTrendNotes.begin(), kTrendNotes.end(), note) != kTrendNotes.end())
        return;
    if (is_day && note == "pulse") {
        add(reading, Grade::care, "a knock: the samples around it were left out");
        return;
    }
    const auto known = std::find_if(kNoteTexts.begin(), kNoteTexts.end(),
                                    [&note](const NoteText& text) { return text.note == note; });
    if (known == kNoteTexts.end()) {
        add(reading, Grade::care, note);
    } else {
        add(reading, known->grade, std::string(known->text));
    }
}

void add_temperature(ReadingGrade& reading, const CorrectedRow& row, bool corrects_rate) {
    std::string doubt = temperature_doubt(row.row);
    if (doubt.empty()) return;
    if (const auto at = doubt.find(';'); at != std::string::npos) doubt.replace(at, 1, ", ");
    const std::string text = "temperature not steady: " + doubt;
    if (corrects_rate) {
        add(reading, Grade::care,
            text + "; it rests on a rate correction of " +
                text::fixed(row.rate_correction.value(), 1) + " mGal");
    } else {
        add(reading, Grade::repeat, text + ", which the model does not correct");
    }
}

/// @param is_left_out  u belongs to the prediction without the row's station, not to its residual.
void add_residual(ReadingGrade& reading, const CorrectedRow& row, bool is_left_out) {
    if (!row.residual || !row.u_corrected || !(row.u_corrected->value() > 0.0)) return;
    const double ratio = is_left_out ? row.studentised_residual.value_or(0.0)
                                     : row.residual->value() / row.u_corrected->value();
    if (std::abs(ratio) <= kCareRatio) return;
    add(reading, std::abs(ratio) > kRepeatRatio ? Grade::repeat : Grade::care,
        "off its reference by " + text::fixed(ratio * row.u_corrected->value(), 1) + " mGal" +
            (is_left_out ? " when its station is left out" : "") + ", " +
            text::fixed(std::abs(ratio), 1) + " times its uncertainty");
}

void add_trends(ReadingGrade& reading, const SurveyRow& row) {
    if (!row.record) return;
    const double difference = row.record->smoother_minus_eemd().value();
    if (std::abs(difference) <= kTrendDifference_mgal) return;
    add(reading, Grade::care,
        "its two trends (smoother, EEMD) differ by " + text::fixed(difference, 2) + " mGal");
}

/// What readings of one station scatter by after all corrections.
struct ReadingScatter {
    std::string name;
    double mgal = 0.0;
};

std::optional<ReadingScatter> scatter_of(const SurveyCorrection& result) {
    if (result.model != "day") {
        if (!result.score.s_mgal) return std::nullopt;
        return ReadingScatter{"s", *result.score.s_mgal};
    }
    // The rest of what the model estimates is taken off the readings.
    for (const Coefficient& coefficient : result.coefficients) {
        if (coefficient.name == "placement_mgal")
            return ReadingScatter{"placement", coefficient.value};
    }
    return std::nullopt;
}

/// A reading to be repeated says nothing about another one.
void add_repeats(std::vector<ReadingGrade>& readings, const SurveyCorrection& result) {
    const auto scatter = scatter_of(result);
    if (!scatter || !(scatter->mgal > 0.0)) return;
    const double expected_mgal = std::sqrt(2.0) * scatter->mgal;
    for (const Closure& pair : close_stations(result)) {
        if (readings[pair.earlier].grade == Grade::repeat) continue;
        if (readings[pair.later].grade == Grade::repeat) continue;
        const double ratio = std::abs(pair.after_all.value()) / expected_mgal;
        if (ratio <= kCareRatio) continue;
        const auto text = [&](std::size_t other) {
            return text::fixed(std::abs(pair.after_all.value()), 1) + " mGal from " +
                   reading_name(result.rows, other) + ", " + text::fixed(ratio, 1) +
                   " times what " + scatter->name + " lets expect";
        };
        add(readings[pair.earlier], Grade::care, text(pair.later));
        add(readings[pair.later], Grade::care, text(pair.earlier));
    }
}

}  // namespace

std::vector<ReadingGrade> grade_readings(const SurveyCorrection& result) {
    const bool corrects_rate =
        std::any_of(result.rows.begin(), result.rows.end(),
                    [](const CorrectedRow& row) { return row.rate_correction != MilliGal(0.0); });
    const bool is_day = result.model == "day";
    std::vector<ReadingGrade> readings;
    for (const CorrectedRow& row : result.rows) {
        ReadingGrade& reading = readings.emplace_back();
        if (row.row.is_flagged) {
            add(reading, row.is_used ? Grade::care : Grade::repeat,
                std::string("marked by the operator as not to be used") +
                    (row.is_used ? ", in the fit all the same" : ""));
        }
        add_temperature(reading, row, corrects_rate);
        add_residual(reading, row, is_day);
        if (!is_day) add_trends(reading, row.row);
        for (const std::string& note : row.row.notes) add_note(reading, note, is_day);
    }
    add_repeats(readings, result);
    return readings;
}

bool has_trusted_reading(const SurveyCorrection& result, const std::vector<ReadingGrade>& grades,
                         const std::string& site) {
    for (std::size_t i = 0; i < grades.size(); ++i) {
        if (result.rows[i].row.site == site && grades[i].grade == Grade::trust) return true;
    }
    return false;
}

}  // namespace a351::corrector
