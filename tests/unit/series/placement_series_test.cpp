#include "corrector/series/placement_series.hpp"

#include <cmath>
#include <random>

#include "corrector/model/calibration_use.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::reading;
using namespace a351::corrector::series;

namespace {

constexpr double kGravity_mgal = 979763.0;

/// Returns set-ups of three minutes, one after another, at a constant temperature.
OccupationRows repeated(std::size_t set_ups, const whole_day::DayNoise& noise, std::uint64_t seed) {
    const UtcTime start = *parse_rfc3339("2026-05-01T00:00:00Z");
    constexpr double kStay_s = 180.0, kLead_s = 7200.0;
    OccupationRows read;
    const auto samples =
        static_cast<std::size_t>((kLead_s + kStay_s * static_cast<double>(set_ups + 1)) / 2.0);
    read.day = DayRecord{{{start, Hertz(0.5), std::vector<double>(samples, 42.5)}, {}}, {}};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < set_ups; ++s) {
        const UtcTime begin =
            start + from_seconds(kLead_s + kStay_s * static_cast<double>(s) + 25.0);
        const StandardGravity x(0.0017 * normal(random)), y(0.0017 * normal(random));
        for (std::size_t b = 0; b < 2; ++b) {
            DayBin bin;
            bin.set_up = s;
            for (std::size_t i = 0; i < kBinSamples; ++i)
                bin.times.push_back(begin +
                                    from_seconds(2.0 * static_cast<double>(b * kBinSamples + i)));
            bin.time = bin.times[kBinSamples / 2];
            bin.x = x;
            bin.y = y;
            read.day->bins.push_back(bin);
        }
        SurveyRow row;
        row.site = "laboratory";
        row.time = begin;
        row.reference = MilliGal(kGravity_mgal);
        row.temperature = DegC(42.5);
        read.rows.push_back(row);
    }
    const linear_algebra::Cholesky factor(whole_day::NoiseCovariance(read.day->bins).at(noise));
    Eigen::VectorXd draws(std::ssize(read.day->bins));
    for (double& draw : draws) draw = normal(random);
    const Eigen::VectorXd errors = factor.lower() * draws;
    for (std::size_t i = 0; i < read.day->bins.size(); ++i)
        read.day->bins[i].reading =
            MilliGal(kGravity_mgal + 1838.0 + errors(static_cast<Eigen::Index>(i)));
    return read;
}

std::string refusal_of(const OccupationRows& read) {
    try {
        static_cast<void>(measure_placement(read, {}, "monday"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("the limits of the placement contain the truth as often as they say") {
    int within = 0, count = 0;
    double squares = 0.0;
    for (const double truth : {0.6, 1.2, 2.4})
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const PlacementSeries found =
                measure_placement(repeated(20, {truth, 1.2, 0.2}, 100 * seed), {}, "placement");
            const unit::Placement& placement = found.placement;
            CHECK(found.set_ups == 20);
            CHECK(placement.low_mgal < placement.mgal);
            CHECK(placement.mgal < placement.high_mgal);
            within += placement.low_mgal <= truth && truth <= placement.high_mgal;
            squares += std::pow(std::log(placement.mgal / truth), 2);
            ++count;
        }
    const double rms = std::sqrt(squares / count);
    INFO(within << " of " << count << " within the limits, rms of ln(found / truth) " << rms);
    CHECK(within >= 26);
    CHECK(rms < 0.3);
}

TEST_CASE("two series of a unit give narrower limits than one") {
    const PlacementSeries one = measure_placement(repeated(20, {1.2, 1.2, 0.2}, 5), {}, "one");
    const PlacementSeries other = measure_placement(repeated(20, {1.2, 1.2, 0.2}, 6), {}, "other");
    const unit::Placement both = combine({one, other});
    CHECK(combine({one}) == one.placement);
    CHECK(both.log_error() <
          0.85 * std::min(one.placement.log_error(), other.placement.log_error()));
    CHECK(both.low_mgal < both.mgal);
    const auto [low, high] = std::minmax(one.placement.mgal, other.placement.mgal);
    CHECK(both.mgal > 0.9 * low);
    CHECK(both.mgal < 1.1 * high);
}

TEST_CASE("a series that does not show the placement is refused with the reason") {
    OccupationRows read = repeated(8, {1.2, 1.2, 0.2}, 1);
    CHECK(refusal_of(read) == "accepted");
    read.rows.back().is_flagged = true;
    CHECK(refusal_of(read) ==
          "monday: placement: 7 set-ups; allowed: 8 or more, about 20 are good");
    read = repeated(20, {1.2, 1.2, 0.2}, 1);
    read.rows.back().site = "field";
    CHECK(refusal_of(read) ==
          "monday: placement: set-ups at laboratory and field; allowed: one point");
    read.rows.back().site = "laboratory";
    read.day.reset();
    CHECK_THAT(refusal_of(read), ContainsSubstring("monday: placement: needs the record"));
}

TEST_CASE("a measured placement is the prior of a day") {
    unit::Calibration calibration;
    calibration.placement = unit::Placement{0.5, 0.49, 0.51};
    CHECK(model::helps_to_correct_day(calibration));
    const whole_day::DayPriors priors = model::day_priors_of(calibration);
    CHECK(priors.placement_mgal.median == 0.5);
    // The readings of this day would have it 2 mGal.
    const OccupationRows read = repeated(20, {2.0, 0.3, 0.2}, 3);
    std::vector<whole_day::DayStation> stations(20, {MilliGal(kGravity_mgal), 0});
    CHECK(whole_day::adjust_day({&*read.day, stations})->fit().noise.placement_mgal > 1.4);
    CHECK(whole_day::adjust_day({&*read.day, stations, priors})->fit().noise.placement_mgal < 0.7);
}
