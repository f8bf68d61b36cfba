#include "corrector/whole_day/day_model.hpp"

#include <map>

#include "protocol/linear_algebra/cholesky.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;
using a351::corrector::reading::DayBin;
using a351::corrector::reading::DayRecord;

namespace {

constexpr std::array<std::size_t, 3> kUnknown{3, 5, 9};

/// Returns the stations of the made-up day with three of them unknown.
std::vector<DayStation> some_known() { return stations_without({3, 5, 9}); }

DaySurvey survey_of(const DayRecord& record, std::size_t unit) {
    return corrector::whole_day::survey_of(record, unit, some_known());
}

/// Returns the records of a box of sensors: a share of the placement's variance is common.
std::vector<DayRecord> box_of(std::size_t sensors, double share, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    constexpr double kPlacement_mgal = 1.2;
    std::vector<double> in_common(MadeUpDay::kSetUps);
    for (double& value : in_common) value = kPlacement_mgal * std::sqrt(share) * normal(random);
    std::vector<DayRecord> records;
    for (std::size_t k = 0; k < sensors; ++k) {
        const MadeUpDay day{.placement_mgal = kPlacement_mgal * std::sqrt(1.0 - share),
                            .white_mgal = 0.2};
        records.push_back(day.record(1000 * seed + k));
        for (DayBin& bin : records.back().bins)
            bin.reading = bin.reading + MilliGal(in_common[bin.set_up]);
    }
    return records;
}

/// Returns twice the cost and the gravities by dense matrices: the readings of all surveys have the
/// covariance of noise, common placement and unknowns.
std::pair<double, std::vector<double>> dense(const std::vector<DaySurvey>& surveys,
                                             const DayProblem& problem, const DayPoint& point,
                                             const std::vector<double>& rough_mgal) {
    Eigen::Index rows = 0;
    for (const DaySurvey& survey : surveys) rows += std::ssize(survey.record->bins);
    Eigen::VectorXd y(rows);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
    std::map<std::string, Eigen::VectorXd> columns;  // of the unknowns, by name
    Eigen::Index begin = 0;
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        const DaySurvey& survey = surveys[k];
        const Eigen::Index count = std::ssize(survey.record->bins);
        const Eigen::MatrixXd scaled = problem.of(k).scaled(problem.part_of(point, k));
        y.segment(begin, count) = scaled.col(0);
        covariance.block(begin, begin, count, count) =
            NoiseCovariance(survey.record->bins).at(problem.own_noise(point, k));
        const auto add = [&](const std::string& name, Eigen::Index column) {
            columns.emplace(name, Eigen::VectorXd::Zero(rows))
                .first->second.segment(begin, count) += scaled.col(column + 1);
        };
        for (Eigen::Index term = 0; term < kTerms; ++term) {
            const auto of = static_cast<DayTerm>(term);
            const bool is_of_day =
                of == DayTerm::constant || of == DayTerm::drift || of == DayTerm::warm_up;
            add((is_of_day ? "day " + std::to_string(k) : "unit " + std::to_string(survey.unit)) +
                    " term " + std::to_string(term),
                term);
        }
        for (Eigen::Index at = problem.of(k).outer_begin(); at < problem.of(k).estimated(); ++at)
            add("unit " + std::to_string(survey.unit) + " outer " + std::to_string(at), at);
        for (std::size_t number = 0; number < survey.gravities.size(); ++number)
            if (const Eigen::Index place = problem.of(k).place_of(number); place >= 0)
                add("gravity " + std::to_string(survey.gravities[number]), place);
        begin += count;
    }
    if (problem.has_boxes()) {
        // Bins of one set-up, of whichever sensor, have the common placement together.
        const double variance =
            point.share *
            std::pow(problem.of(0).noise(problem.part_of(point, 0)).placement_mgal, 2);
        const auto count = static_cast<Eigen::Index>(surveys.front().record->bins.size());
        for (Eigen::Index i = 0; i < rows; ++i)
            for (Eigen::Index j = 0; j < rows; ++j)
                if (surveys.front().record->bins[static_cast<std::size_t>(i % count)].set_up ==
                    surveys.front().record->bins[static_cast<std::size_t>(j % count)].set_up)
                    covariance(i, j) += variance;
    }
    for (const auto& [name, column] : columns) covariance += column * column.transpose();
    const linear_algebra::Cholesky factor(covariance);
    double twice = factor.log_determinant() + factor.half_solve(y).squaredNorm();
    for (const double u : point.u) twice += u * u;
    // Expectation of a coefficient of variance 1, given the readings: column' covariance^-1 y.
    const Eigen::VectorXd solved = factor.solve(y);
    std::vector<double> gravities = rough_mgal;
    for (const std::size_t number : kUnknown)
        gravities[number] +=
            kFreeGravity_mgal * columns.at("gravity " + std::to_string(number)).dot(solved);
    return {twice, gravities};
}

}  // namespace

TEST_CASE("the likelihood and the gravities of a box are those of dense matrices") {
    std::vector<DayRecord> records = box_of(2, 0.5, 5);
    records[0] = with_outer_oven(records[0], 2.0, 5.0);
    const std::vector<DaySurvey> surveys{survey_of(records[0], 0), survey_of(records[1], 1)};
    std::vector<double> rough_mgal;
    for (std::size_t s = 0; s < MadeUpDay::kSites; ++s)
        rough_mgal.push_back(MadeUpDay::gravity_mgal(s) + 0.5);
    const DayProblem problem(surveys, rough_mgal);
    REQUIRE(problem.groups().size() == 1);
    // Both lags of either unit; placement; flicker and white noise of either survey; size of the biases,
    // lag and size of the outer oven's effect of the first unit; size of the biases of the second.
    const std::vector<DayPoint> points{
        {{0.1, -0.2, -0.4, 0.2, 0.2, -1.0, 0.1, -0.5, 0.0, 0.3, 0.6, 0.4, 0.0}, 0.6},
        {{0.1, -0.2, -0.4, 0.2, 0.7, -1.0, 0.1, -0.5, 0.2, 0.3, 0.0, 0.0, 0.0}, 1.0},
        {std::vector<double>(13), 0.0}};
    REQUIRE(problem.hypers().size() == points.front().u.size());
    // Lags, placement, flicker, white, size of the biases, lag and size of the outer oven's effect.
    CHECK(problem.part_of(points[0], 0) == SurveyPoint{0.1, -0.2, 0.2, -1.0, 0.1, 0.3, 0.6, 0.4});
    CHECK(problem.part_of(points[0], 1) == SurveyPoint{-0.4, 0.2, 0.2, -0.5, 0.0, 0.0, 0.0, 0.0});
    for (const DayPoint& point : points) {
        std::vector<DayProblem::Normal> normals;
        std::vector<Eigen::MatrixXd> scaled;
        for (std::size_t k = 0; k < surveys.size(); ++k) {
            scaled.push_back(problem.of(k).scaled(problem.part_of(point, k)));
            normals.push_back(problem.of_survey(point, k, scaled[k]));
        }
        const auto reduced = problem.reduced(problem.of_group(normals, 0), 0);
        const auto [twice, gravities] = dense(surveys, problem, point, rough_mgal);
        CHECK(2.0 * problem.cost(point, reduced) == Approx(twice).margin(1e-3));
        const auto solution = problem.solve(point, scaled).surveys;
        for (const std::size_t number : kUnknown)
            for (const std::size_t k : {0U, 1U})
                CHECK(rough_mgal[number] +
                          kFreeGravity_mgal * solution[k](problem.of(k).place_of(number)) ==
                      Approx(gravities[number]).margin(1e-4));
    }
}

TEST_CASE("a day in one face and one in two have the same slopes") {
    // Half of the response acts on the scale, which the day in one face cannot see.
    MadeUpDay two{.has_two_faces = true, .scale_share = 0.5}, one = two;
    one.has_two_faces = false;
    const DayRecord a = two.record(11), b = later(one.record(12), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 0)});
    for (const std::size_t survey : {0U, 1U})
        CHECK(coefficient(joint.fit(survey), DayTerm::level).value ==
              Approx(two.level).margin(0.1));
    CHECK(joint.fit(0).on_scale.at(0).value == Approx(0.5 * two.level).margin(0.1));
    CHECK(joint.fit(1).on_scale.empty());
    for (const std::size_t number : kUnknown)
        CHECK(joint.gravity(number).value == Approx(MadeUpDay::gravity_mgal(number)).margin(0.01));
}

TEST_CASE("days of one unit share its response, and have their own constants") {
    MadeUpDay second = kScattered;
    second.constant += 400.0;
    second.drift = -0.7;
    const DayRecord a = kScattered.record(11), b = later(second.record(12), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 0)});
    const FittedDay alone = fit_day(a, some_known()).value(),
                    other = fit_day(b, some_known()).value();
    CHECK(coefficient(joint.fit(0), DayTerm::level).value ==
          Approx(coefficient(joint.fit(1), DayTerm::level).value));
    CHECK(coefficient(joint.fit(0), DayTerm::level).standard_error <
          0.85 * coefficient(alone, DayTerm::level).standard_error);
    CHECK(coefficient(joint.fit(1), DayTerm::constant).value -
              coefficient(joint.fit(0), DayTerm::constant).value ==
          Approx(400.0).margin(6.0));
    for (const std::size_t number : kUnknown) {
        const Estimate gravity = joint.gravity(number);
        CHECK(gravity.standard_error < alone.gravity_mgal[number].standard_error);
        CHECK(gravity.standard_error < other.gravity_mgal[number].standard_error);
        CHECK(std::abs(gravity.value - MadeUpDay::gravity_mgal(number)) <
              3.0 * gravity.standard_error);
    }
    CHECK_FALSE(joint.share());
}

TEST_CASE("units with only stations in common give the weighted mean of their days") {
    const DayRecord a = kScattered.record(21), b = later(kScattered.record(22), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 1)});
    const FittedDay of_a = fit_day(a, some_known()).value(),
                    of_b = fit_day(b, some_known()).value();
    for (const std::size_t number : kUnknown) {
        const double u_a = of_a.gravity_mgal[number].standard_error,
                     u_b = of_b.gravity_mgal[number].standard_error;
        const double weight = 1.0 / (u_a * u_a), other = 1.0 / (u_b * u_b);
        CHECK(joint.gravity(number).value == Approx((weight * of_a.gravity_mgal[number].value +
                                                     other * of_b.gravity_mgal[number].value) /
                                                    (weight + other))
                                                 .margin(0.25));
        CHECK(joint.gravity(number).standard_error ==
              Approx(1.0 / std::sqrt(weight + other)).epsilon(0.15));
    }
}

TEST_CASE("the share of the placement that a box has is found") {
    double last_u_mgal = 0.0;
    for (const double share : {0.0, 1.0}) {
        const std::vector<DayRecord> records = box_of(3, share, 8);
        std::vector<DaySurvey> surveys;
        for (std::size_t k = 0; k < records.size(); ++k)
            surveys.push_back(survey_of(records[k], k));
        const DayAdjustment joint = adjust_days(surveys);
        REQUIRE(joint.share());
        CHECK(joint.share()->lowest <= share);
        CHECK(joint.share()->highest >= share);
        CHECK(std::abs(joint.share()->expected - share) < 0.4);
        CHECK(joint.fit().noise.placement_mgal == Approx(1.2).epsilon(0.4));
        // More sensors do not reduce their common error.
        const double u_mgal = joint.gravity(9).standard_error;
        CHECK(u_mgal > last_u_mgal);
        last_u_mgal = u_mgal;
    }
}

TEST_CASE("the order of surveys has no effect on the gravities") {
    const std::vector<DayRecord> records = box_of(2, 0.5, 9);
    const DayRecord next = later(kScattered.record(31), kOneDay);
    const DayAdjustment one =
        adjust_days({survey_of(records[0], 0), survey_of(records[1], 1), survey_of(next, 0)});
    const DayAdjustment other =
        adjust_days({survey_of(next, 1), survey_of(records[1], 0), survey_of(records[0], 1)});
    REQUIRE(one.share());
    CHECK(other.share()->expected == Approx(one.share()->expected).margin(0.02));
    for (const std::size_t number : kUnknown)
        CHECK(other.gravity(number).value == Approx(one.gravity(number).value).margin(0.02));
}
