#include "corrector/long_record/two_path_fit.hpp"

#include <cmath>
#include <utility>

#include "corrector/long_record/two_path_regression.hpp"
#include "corrector/whole_day/day_priors.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/moments.hpp"

namespace a351::corrector::long_record {
namespace {

using Index = Eigen::Index;

/// A parameter in words.
struct Named {
    const char *key, *name, *unit, *needed;
};
constexpr const char* kByDays =
    text::marked("a set point that moves by about 0.1 degC every few hours, for two days or more");
constexpr const char* kFromPowerOn =
    text::marked("a record that begins when the sensor is switched on");
constexpr const char* kByOuterOven =
    text::marked("an outer oven whose set point moves by a degree every few hours");
/// Parameters in the order of TwoPathTerm, then slopes and lag of the outer oven.
constexpr std::array<Named, kTwoPathTerms + 3> kNamed{{
    {"drift_mgal_per_h", text::marked("drift"), "mGal/h", text::marked("a week or more")},
    {"warm_up_mgal", text::marked("warm-up at the start"), "mGal", kFromPowerOn},
    {"level_mgal_per_degc", text::marked("static slope, prompt"), "mGal/degC", kByDays},
    {"fast_mgal_per_degc_per_h", text::marked("fast path"), "mGal/(degC/h)",
     text::marked("a larger temperature swing at periods of 5 to 30 min")},
    {"slow_mgal_per_degc", text::marked("static slope, late"), "mGal/degC", kByDays},
    {"fast_lag_s", text::marked("lag of the fast path"), "s",
     text::marked("a larger temperature swing at periods of 4 to 8 min")},
    {"slow_lag_s", text::marked("lag of the slow path"), "s", kByDays},
    {"warm_up_time_s", text::marked("time constant of the warm-up"), "s", kFromPowerOn},
    {whole_day::kOuterNames[0].data(), text::marked("slope by the outer oven, prompt"), "mGal/degC",
     kByOuterOven},
    {whole_day::kOuterNames[1].data(), text::marked("slope by the outer oven, late"), "mGal/degC",
     kByOuterOven},
    {whole_day::kOuterNames[2].data(), text::marked("lag of the outer oven"), "s", kByOuterOven},
}};

}  // namespace

TwoPathFit fit_two_paths(const std::vector<double>& temperature_degc,
                         const std::vector<double>& acceleration_mgal, double step_s,
                         double cycle_s, const std::vector<double>& outer_degc) {
    TwoPathRegression regression(temperature_degc, acceleration_mgal, step_s, outer_degc);
    constexpr int kRounds = 4;
    TwoPathLags u{};
    Eigen::VectorXd beta = regression.coefficients(u);
    for (int round = 0; round < kRounds; ++round) {
        regression.update_noise(u, beta);
        u = regression.most_likely(u, round > 0);
        beta = regression.coefficients(u);
    }

    TwoPathFit fit;
    const Eigen::MatrixXd scaled = regression.covariance(u, beta);
    Eigen::VectorXd units(static_cast<Index>(kTwoPathTerms));
    for (Index place = 0; place < scaled.rows(); ++place) {
        const auto k = static_cast<std::size_t>(place);
        const bool is_outer = k >= kTwoPathTerms;
        const bool is_lag = is_outer ? place + 1 == scaled.rows() : place >= kTwoPathLinear;
        const std::size_t lag = is_outer ? 3 : k - static_cast<std::size_t>(kTwoPathLinear);
        const Index column = is_outer ? place - units.size() + kTwoPathLinear : place;
        const double one = is_lag ? std::log(kTwoPathLags_s.at(lag).factor)
                                  : kTwoPathDeviations.at(static_cast<std::size_t>(column));
        const double deviation = one * std::sqrt(scaled(place, place));
        const double value = is_lag ? kTwoPathLags_s.at(lag).at(u.at(lag)) : one * beta(column);
        const bool is_determined = std::sqrt(scaled(place, place)) < kDeterminedDeviation;
        const Named& named = kNamed.at(k);
        fit.parameters.push_back(
            {named.key, named.name, named.unit, value, is_lag ? value * deviation : deviation,
             is_determined, is_determined ? text::Message() : text::marked_message(named.needed)});
        if (!is_outer) units(place) = one;
    }
    const auto of_terms = scaled.topLeftCorner(units.size(), units.size());
    fit.covariance = units.asDiagonal() * of_terms * units.asDiagonal();
    constexpr auto level = static_cast<Index>(TwoPathTerm::level),
                   slow = static_cast<Index>(TwoPathTerm::slow);
    fit.static_slope = fit[TwoPathTerm::level].value + fit[TwoPathTerm::slow].value;
    fit.static_slope_error = std::sqrt(fit.covariance(level, level) + fit.covariance(slow, slow) +
                                       2.0 * fit.covariance(level, slow));
    const double prior = std::sqrt(units(level) * units(level) + units(slow) * units(slow));
    fit.is_static_slope_determined = fit.static_slope_error < kDeterminedDeviation * prior;

    const TimeSeries<DegC> whole({}, Hertz(1.0 / step_s), temperature_degc);
    const auto columns = regression.columns(whole, u);
    constexpr auto kInner = static_cast<std::size_t>(kTwoPathLinear),
                   kLags = kTwoPathTerms - kInner;
    fit.residual_mgal = acceleration_mgal;
    for (std::size_t i = 0; i < fit.residual_mgal.size(); ++i)
        for (std::size_t k = 0; k < columns.size(); ++k)
            fit.residual_mgal[i] -=
                columns[k][i] * fit.parameters[k < kInner ? k : k + kLags].value;
    const double mean = signal::mean_of(fit.residual_mgal);
    for (double& value : fit.residual_mgal) value -= mean;
    fit.residual_rms_mgal = std::sqrt(signal::variance_of(fit.residual_mgal));

    for (ResponsePoint& point : response_by_spectrum(
             temperature_degc, fit.residual_mgal, step_s,
             {.cycle_s = cycle_s, .is_joint = true, .noise_degc2 = regression.thermometer_noise()}))
        if (point.refusal.empty()) fit.unexplained.push_back(std::move(point));
    return fit;
}

}  // namespace a351::corrector::long_record
