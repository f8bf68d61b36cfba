#include "corrector/whole_day/day_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "corrector/archive_series/on_all_cores.hpp"

namespace a351::corrector::whole_day {
namespace {

/// Returns true if a set-up whose gravity is held has a bin.
bool is_any_held(const DaySurvey& survey) {
    return std::ranges::any_of(survey.record->bins, [&survey](const reading::DayBin& bin) {
        return survey.stations[bin.set_up].gravity.has_value();
    });
}

/// Returns the mean of the gravities that the surveys found alone, by number in the adjustment.
std::vector<double> rough_gravities_mgal(const std::vector<DaySurvey>& surveys,
                                         const std::vector<std::optional<DayAdjustment>>& alone,
                                         const std::vector<WhiteSurvey>& white_surveys) {
    std::vector<double> sums, counts;
    const auto add = [&](std::size_t number, double value_mgal) {
        sums.resize(std::max(sums.size(), number + 1));
        counts.resize(sums.size());
        sums[number] += value_mgal;
        counts[number] += 1.0;
    };
    for (std::size_t k = 0; k < surveys.size(); ++k)
        for (std::size_t i = 0; i < surveys[k].gravities.size(); ++i)
            add(surveys[k].gravities[i], alone[k]->value_mgal(i));
    for (const WhiteSurvey& survey : white_surveys)
        for (std::size_t k = 0; k < survey.stations.size(); ++k)
            add(survey.stations[k].number,
                survey.block.gravities_mgal(static_cast<Eigen::Index>(k)));
    for (std::size_t number = 0; number < sums.size(); ++number)
        if (counts[number] > 0.0) sums[number] /= counts[number];
    return sums;
}

}  // namespace

std::optional<DayAdjustment> adjust_day(DaySurvey survey, const SurveyPoint* nearby) {
    if (!is_any_held(survey)) return std::nullopt;
    survey.gravities.clear();
    survey.unit = 0;
    const auto problem = std::make_shared<const DayProblem>(std::vector{std::move(survey)});
    return DayAdjustment(problem, search_alone(*problem, nearby));
}

DayAdjustment adjust_days(std::vector<DaySurvey> surveys,
                          const std::vector<WhiteSurvey>& white_surveys) {
    if (surveys.size() == 1 && white_surveys.empty())
        return adjust_day(std::move(surveys.front())).value();
    std::vector<std::optional<DayAdjustment>> alone(surveys.size());
    archive_series::on_all_cores(surveys.size(),
                                 [&](std::size_t k) { alone[k] = adjust_day(surveys[k]); });
    const std::vector<double> rough_mgal = rough_gravities_mgal(surveys, alone, white_surveys);
    const auto problem =
        std::make_shared<const DayProblem>(std::move(surveys), rough_mgal, white_surveys);
    std::vector<SurveyPoint> points;
    for (const auto& one : alone) points.push_back(one->fit().point);
    DayPoint start = mean_point(*problem, points);
    start.share = problem->has_boxes() ? 0.5 : 0.0;
    const DaySearch found = search_together(*problem, std::move(start));
    // An unknown is (1 + k) times its distance from a rough gravity, and units differ in k.  About the
    // gravities that were found the distance is 0.
    const DayAdjustment adjusted(problem, found);
    std::vector<double> found_mgal;
    for (std::size_t number = 0; number < problem->gravity_count(); ++number)
        found_mgal.push_back(adjusted.value_mgal(number));
    return DayAdjustment(
        std::make_shared<const DayProblem>(problem->surveys(), found_mgal, white_surveys), found);
}

std::optional<DayAdjustment> adjust_planned_day(reading::DayRecord& record, DaySurvey survey,
                                                const DayNoise& noise) {
    survey.record = &record;
    if (!is_any_held(survey)) return std::nullopt;
    // The share of the scale is held, so that what is not known of it is added here.
    survey.priors.share_spread =
        std::hypot(survey.priors.share_spread, survey.priors.scale_share.deviation);
    // Nobody knows where the unknown stations are: the scale then has no part in them.
    const MilliGal usual = *std::ranges::find_if(survey.stations, [](const DayStation& station) {
                                return station.gravity.has_value();
                            })->gravity;
    for (reading::DayBin& bin : record.bins)
        bin.reading = bin.tide + survey.stations[bin.set_up].gravity.value_or(usual);
    const DayRegression bare(survey);
    const Eigen::VectorXd effects =
        bare.design({}) * bare.unscaled({}, Eigen::VectorXd::Zero(bare.estimated()));
    for (std::size_t i = 0; i < record.bins.size(); ++i) {
        MilliGal& reading = record.bins[i].reading;
        reading = reading + MilliGal(record.bins[i].face * effects(static_cast<Eigen::Index>(i)));
    }
    const auto problem = std::make_shared<const DayProblem>(std::vector{std::move(survey)});
    const DayPoint point = mean_point(*problem, {problem->of(0).point_of(noise)});
    return DayAdjustment(problem, {point, point, std::nullopt, std::nullopt});
}

}  // namespace a351::corrector::whole_day
