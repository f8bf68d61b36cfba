#include "corrector/series/tilt_series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/series/series_rows.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "protocol/core/units.hpp"
#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/unit/combined_estimates.hpp"

namespace a351::corrector::series {
namespace {

// Number of set-ups: level, four tilts, level again.
constexpr std::size_t kFewestSetUps = 6;
// Least tilt of each axis to both sides.  A bias of 2 Gal then changes the reading by 17 mGal, ten
// times the scatter of set-ups.
constexpr double kLeastTilt_deg = 0.5;
// Greatest range of temperature between set-ups.  0.3 degC change the reading by 10 mGal, of which
// the fit may leave a tenth.
constexpr double kGreatestRange_degc = 0.3;

double tilt_deg(StandardGravity along) {
    return kDegPerRad * std::asin(std::clamp(along.value(), -1.0, 1.0));
}

/// Returns the tilts of the horizontal axes of all bins in use, degrees (bins, 2).
Eigen::MatrixXd tilts_deg(const reading::OccupationRows& read) {
    const std::vector<reading::DayBin>& bins = read.day->bins;
    Eigen::MatrixXd all(static_cast<Eigen::Index>(bins.size()), 2);
    Eigen::Index count = 0;
    for (const reading::DayBin& bin : bins)
        if (is_in_series(read.rows[bin.set_up]))
            all.row(count++) << tilt_deg(bin.x), tilt_deg(bin.y);
    return all.topRows(count);
}

void require_both_axes(const Eigen::MatrixXd& tilts, const CheckedSeries& checked) {
    const std::string allowed =
        fmt::format("both axes tilted by {} deg or more to both sides, one at a time",
                    text::fixed(kLeastTilt_deg, 1));
    for (const Eigen::Index axis : {0, 1}) {
        const double least = tilts.col(axis).minCoeff(), greatest = tilts.col(axis).maxCoeff();
        if (least <= -kLeastTilt_deg && greatest >= kLeastTilt_deg) continue;
        checked.refuse(fmt::format("{} is tilted from {} to {} deg", axis == 0 ? "x" : "y",
                                   text::fixed(least, 2), text::fixed(greatest, 2)),
                       allowed);
    }
    const Eigen::MatrixXd centred = tilts.rowwise() - tilts.colwise().mean();
    const linear_algebra::SymmetricEigen axes = linear_algebra::symmetric_eigen(
        centred.transpose() * centred / static_cast<double>(tilts.rows()));
    const double across = std::sqrt(std::max(0.0, axes.values(0)));
    if (across < kLeastTilt_deg / 2.0)
        checked.refuse(
            fmt::format("x and y are tilted together: in the other direction the tilts scatter "
                        "by only {} deg",
                        text::fixed(across, 2)),
            allowed);
}

double temperature_range_degc(const reading::OccupationRows& read) {
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (const reading::SurveyRow& row : read.rows) {
        if (!is_in_series(row)) continue;
        least = std::min(least, row.temperature.value());
        greatest = std::max(greatest, row.temperature.value());
    }
    return greatest - least;
}

void require_tilt_series(const TiltSeries& series, const CheckedSeries& checked) {
    checked.require_one_point();
    if (series.set_ups < kFewestSetUps)
        checked.refuse(fmt::format("{} set-ups", series.set_ups),
                       fmt::format("{} or more", kFewestSetUps));
    if (series.temperature_range_degc > kGreatestRange_degc)
        checked.refuse(fmt::format("the temperature moved by {} degC between set-ups",
                                   text::fixed(series.temperature_range_degc, 2)),
                       text::fixed(kGreatestRange_degc, 1) + " degC");
    checked.require_day();
    require_both_axes(tilts_deg(checked.read), checked);
}

/// Returns the bins with the reading |mean vector - biases|, biases in mGal.
std::vector<reading::DayBin> freed_from(const std::vector<reading::DayBin>& bins,
                                        const Eigen::Vector3d& biases) {
    std::vector<reading::DayBin> freed = bins;
    for (reading::DayBin& bin : freed) {
        const double x = bin.x.value() * kMilliGalPerStandardGravity;
        const double y = bin.y.value() * kMilliGalPerStandardGravity;
        const double norm = bin.reading.value();
        const double z = std::sqrt(norm * norm - x * x - y * y);
        bin.reading = MilliGal((Eigen::Vector3d(x, y, z) - biases).norm());
    }
    return freed;
}

}  // namespace

TiltSeries measure_axis_bias(const reading::OccupationRows& read, const std::string& origin) {
    TiltSeries series;
    const CheckedSeries checked{"tilt series", origin, read};
    series.set_ups = checked.set_ups();
    series.temperature_range_degc = temperature_range_degc(read);
    require_tilt_series(series, checked);
    const Eigen::MatrixXd tilts = tilts_deg(read);
    for (const std::size_t axis : {0U, 1U}) {
        const auto column = tilts.col(static_cast<Eigen::Index>(axis));
        series.least_tilt_deg.at(axis) = column.minCoeff();
        series.greatest_tilt_deg.at(axis) = column.maxCoeff();
    }

    // An error of gravity acts like a vertical bias, whose effect is even in the tilt.
    const MilliGal gravity = checked.gravity();
    whole_day::DaySurvey survey;
    survey.priors.free_axes();
    survey.stations = checked.stations();
    double mean = 0.0;
    for (const reading::DayBin& bin : read.day->bins)
        if (is_in_series(read.rows[bin.set_up]))
            mean += (bin.reading - gravity).value() / static_cast<double>(tilts.rows());

    Eigen::Vector3d biases(0.0, 0.0, mean);
    constexpr int kRounds = 3;  // each round leaves about 1e-3 of the change of the round before
    reading::DayRecord day = *read.day;
    const auto x = whole_day::DayPriors::place_of(whole_day::DayTerm::x),
               y = whole_day::DayPriors::place_of(whole_day::DayTerm::y);
    const whole_day::DayPriors& priors = survey.priors;
    survey.record = &day;
    for (int round = 0; round < kRounds; ++round) {
        day.bins = freed_from(read.day->bins, biases);
        const whole_day::DayFit fit = whole_day::adjust_day(survey).value().fit();
        const whole_day::DayPriors::Vector change = priors.factor * fit.shift;
        const whole_day::DayPriors::Matrix covariance =
            priors.factor * fit.shift_covariance * priors.factor.transpose();
        biases.head<2>() += Eigen::Vector2d(change(x), change(y));
        series.bias.values = biases.head<2>();
        series.bias.covariance << covariance(x, x), covariance(x, y), covariance(x, y),
            covariance(y, y);
        series.placement_mgal = fit.noise.placement_mgal;
    }
    return series;
}

unit::AxisBias combine(const std::vector<TiltSeries>& series) {
    std::vector<unit::AxisBias> estimates;
    for (const TiltSeries& one : series) estimates.push_back(one.bias);
    return unit::combined(estimates);
}

}  // namespace a351::corrector::series
