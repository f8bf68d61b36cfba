/// Computes how exactly a survey day could find the scale of the sensor if everything else were known.
///
///     known-scale SURVEY.toml PLACEMENT_MGAL FLICKER_MGAL
///
/// Prints the standard error of the scale with this noise and a known response to temperature.  White
/// noise is the one that the day has found.  The survey file has a table [reference].

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "corrector/job/reference_survey.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/model/adjusted_day.hpp"
#include "corrector/model/calibration_use.hpp"

int main(int argc, char** argv) {
    namespace corrector = a351::corrector;
    namespace whole_day = corrector::whole_day;
    using Priors = whole_day::DayPriors;
    using Term = whole_day::DayTerm;
    if (argc < 4) return 2;
    const auto survey = corrector::job::read_survey_file(argv[1]);
    auto read = corrector::job::read_survey(survey, [](std::size_t, std::size_t) {});
    static_cast<void>(corrector::job::hold_reference_values(survey, read));
    const auto options = corrector::job::with_sites_of(read, survey.survey);
    const auto choice = corrector::model::choose_rows(read.rows, options.datum, options.use_flags);
    whole_day::DaySurvey day = corrector::model::day_survey(
        {read.rows, options, &*read.day}, choice, corrector::model::day_priors_of(options));
    const whole_day::DayFit found = whole_day::adjust_day(day).value().fit();
    constexpr double kKnown = 1e-8;  // relative to the prior: nothing is left to be found
    for (const Eigen::Index place :
         {Eigen::Index{0}, Eigen::Index{1}, Priors::place_of(Term::level),
          Priors::place_of(Term::slow), Priors::place_of(Term::fast)})
        day.priors.factor.row(place) *= kKnown;
    const whole_day::DayNoise noise{std::atof(argv[2]), std::atof(argv[3]), found.noise.white_mgal};
    const auto known = whole_day::adjust_planned_day(*read.day, day, noise).value().fit();
    std::printf("%.6f\n",
                known.coefficients.at(static_cast<std::size_t>(Term::scale)).standard_error);
}
