#include "corrector/judgement/contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "corrector/judgement/closure.hpp"
#include "corrector/judgement/far_terms.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

using reading::Finding;
using reading::FindingKind;

/// Weight of the placement that is assumed of a box, as a number of pairs of set-ups: a choice.
constexpr double kUsualWeight = 4.0;

/// Least ratio of the contradictions that are added.
struct Limit {
    double ratio = kContradictionRatio;
    bool is_lesser = false;
};

Contradiction about(const reading::SurveyRow& row, std::string code, text::Message text,
                    bool is_lesser = false) {
    return {std::move(code), row.site, row.occupation, row.key, std::move(text), is_lesser};
}

bool is_named(const std::vector<Contradiction>& all, const reading::SurveyRow& row) {
    return std::ranges::any_of(
        all, [&](const Contradiction& one) { return reading::is_same_stay(one, row); });
}

std::string size_of(double mgal) { return text::fixed(std::abs(mgal), 1); }

text::Message off_reference(const reading::SurveyRow& row, double off_mgal) {
    return text::message(
        "{} ({}) differs from its reference by {} mGal: check its name and its reference, then "
        "read it again",
        row.site, row.occupation, size_of(off_mgal));
}

void add_findings(std::vector<Contradiction>& all, const model::SurveyCorrection& result) {
    for (const Finding& finding : result.findings) {
        const bool is_of_reading =
            reading::is_mistake(finding) ||
            // A wrong unit is of the whole day, and no reading at this benchmark can clear it up.
            (finding.kind == FindingKind::scale && finding.code != kFarBiasCode);
        if (!is_of_reading) continue;
        // Without a key, the code says which one.
        const std::string code = finding.key.empty() && finding.time
                                     ? finding.code + ' ' + to_rfc3339(*finding.time)
                                     : finding.code;
        all.push_back(
            {code, finding.site, finding.occupation.value_or(1), finding.key, finding.text});
    }
}

/// Returns the difference from the reference if the station is left out, in its uncertainties.
std::optional<double> ratio_of(const model::CorrectedRow& row) {
    if (row.row.is_reference_refused || row.as<model::WholeDayRow>() == nullptr)
        return std::nullopt;
    return row.studentised_residual;
}

void add_references(std::vector<Contradiction>& all, const model::SurveyCorrection& result,
                    const Limit& limit) {
    std::vector<std::string> known;  // Sites with a reference in the fit.
    double largest = 0.0;
    for (const model::CorrectedRow& row : result.rows) {
        const auto ratio = ratio_of(row);
        if (!ratio) continue;
        largest = std::max(largest, std::abs(*ratio));
        if (std::ranges::count(known, row.row.site) == 0) known.push_back(row.row.site);
    }
    for (const model::CorrectedRow& row : result.rows) {
        const auto ratio = ratio_of(row);
        if (!ratio || std::abs(*ratio) <= kLesserRatio) continue;
        if ((known.size() == 2 ? largest : std::abs(*ratio)) <= limit.ratio) continue;
        if (is_named(all, row.row)) {
            if (known.size() == 2) return;
            continue;
        }
        const double off_mgal =
            (*row.as<model::WholeDayRow>()->left_out - *row.row.reference).value();
        all.push_back(
            about(row.row, "references",
                  known.size() == 2
                      ? text::message(
                            "{} and {} contradict each other by {} mGal: one of them has a wrong "
                            "name or reference; read a third known benchmark",
                            known[0], known[1], size_of(off_mgal))
                      : off_reference(row.row, off_mgal),
                  limit.is_lesser));
        if (known.size() == 2) return;  // The other one says the same.
    }
}

/// Returns the placement that the set-ups of other stays show, mGal.
///
/// The fit's own placement is no measure: the set-up that is off enlarges it.
double placement_without(const std::vector<Closure>& pairs, const Closure& judged,
                         const std::vector<model::CorrectedRow>& rows) {
    const reading::SurveyRow& stay = rows[judged.later].row;
    const double usual_mgal = whole_day::kUsualPlacement_mgal.median;
    double weight = kUsualWeight, sum = kUsualWeight * usual_mgal * usual_mgal;
    for (const Closure& pair : pairs) {
        const reading::SurveyRow& other = rows[pair.later].row;
        if (is_same_stay(other, stay)) continue;
        sum += 0.5 * pair.after_all.value() * pair.after_all.value();
        ++weight;
    }
    return std::sqrt(sum / weight);
}

void add_set_ups(std::vector<Contradiction>& all, const model::SurveyCorrection& result,
                 const std::string& running_key, const Limit& limit) {
    std::vector<Closure> pairs = close_stations(result);
    std::erase_if(pairs, [](const Closure& pair) { return pair.drift_mgal_per_h.has_value(); });
    for (const Closure& pair : pairs) {
        const reading::SurveyRow& row = result.rows[pair.later].row;
        const double difference_mgal = std::abs(pair.after_all.value());
        const double expected_mgal =
            std::numbers::sqrt2 * placement_without(pairs, pair, result.rows);
        if (difference_mgal <= limit.ratio * expected_mgal || is_named(all, row)) continue;
        all.push_back(about(
            row, "set_ups",
            text::message("{} and {} differ by {} mGal, {} times what their placement allows: ",
                          reading_name(result.rows, pair.earlier),
                          reading_name(result.rows, pair.later), text::fixed(difference_mgal, 1),
                          text::fixed(difference_mgal / expected_mgal, 1)) +
                (row.key == running_key && !running_key.empty()
                     ? text::message("lift the box, set it down level, and add a set-up")
                     : text::message("read it again if you pass there")),
            limit.is_lesser));
    }
}

}  // namespace

std::vector<Contradiction> contradictions(const model::SurveyCorrection& result,
                                          const std::string& running_key) {
    std::vector<Contradiction> all;
    add_findings(all, result);
    // A stay is named once.  A lesser contradiction hides no greater one.
    for (const Limit& limit : {Limit{}, Limit{kLesserRatio, true}}) {
        add_references(all, result, limit);
        add_set_ups(all, result, running_key, limit);
    }
    return all;
}

double doubt_factor(const model::SurveyCorrection& result) {
    std::vector<double> ratios;
    for (const model::CorrectedRow& row : result.rows)
        if (const auto ratio = ratio_of(row)) ratios.push_back(std::abs(*ratio));
    if (ratios.empty()) return 1.0;
    return std::max(1.0, signal::kGaussianPerMad * signal::median(std::move(ratios)));
}

}  // namespace a351::corrector::judgement
