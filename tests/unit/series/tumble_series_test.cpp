#include "corrector/series/tumble_series.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/long_tests.hpp"

using namespace a351;
using namespace a351::corrector::series;
using namespace a351::corrector::reading;

namespace {

constexpr double kTumbledGravity_mgal = 979763.0;

/// A sensor: bias and quadratic term at 1 g in mGal, scale, angles as Tumble::angle_rad; changes of bias
/// and scale with temperature, mGal/degC.
struct Truth {
    Eigen::Vector3d bias, scale, quadratic, angle;
    Eigen::Vector3d bias_by_degc = Eigen::Vector3d::Zero(), scale_by_degc = bias_by_degc;
};

Truth drawn(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const auto three = [&](double deviation) {
        return Eigen::Vector3d(deviation * normal(random), deviation * normal(random),
                               deviation * normal(random));
    };
    return {three(7000.0), Eigen::Vector3d::Ones() + three(5e-3), three(150.0), three(1.5e-3)};
}

/// Six positions along the axes, then twelve halfway between two of them.
std::vector<Eigen::Vector3d> directions(bool is_halfway_too) {
    std::vector<Eigen::Vector3d> list;
    for (int k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0}) list.push_back(sign * Eigen::Vector3d::Unit(k));
    if (!is_halfway_too) return list;
    for (int k = 0; k < 3; ++k)
        for (const double one : {1.0, -1.0})
            for (const double other : {1.0, -1.0})
                list.push_back(
                    (one * Eigen::Vector3d::Unit(k) + other * Eigen::Vector3d::Unit((k + 1) % 3)) /
                    std::numbers::sqrt2);
    return list;
}

/// Returns the sensor's values in the positions, each up to a degree off.
OccupationRows tumbled(const Truth& truth, const std::vector<Eigen::Vector3d>& positions,
                       std::mt19937_64& random, double noise_mgal = 1.7, double degc = 42.5) {
    std::normal_distribution<double> normal;
    OccupationRows read;
    for (const Eigen::Vector3d& position : positions) {
        const Eigen::Vector3d askew(normal(random), normal(random), normal(random));
        const Eigen::Vector3d a = kTumbledGravity_mgal * (position + 0.01 * askew).normalized();
        const Eigen::Vector3d in_g = a / kMilliGalPerStandardGravity;
        Eigen::Matrix3d cross =
            (truth.scale + (degc - 42.5) / kMilliGalPerStandardGravity * truth.scale_by_degc)
                .asDiagonal();
        cross(0, 1) = cross(1, 0) = 0.5 * truth.angle(0);
        cross(0, 2) = cross(2, 0) = 0.5 * truth.angle(1);
        cross(1, 2) = cross(2, 1) = 0.5 * truth.angle(2);
        Eigen::Vector3d mean = cross * a + truth.bias + (degc - 42.5) * truth.bias_by_degc +
                               truth.quadratic.cwiseProduct(in_g.cwiseProduct(in_g));
        mean += noise_mgal * normal(random) * a.normalized();
        RecordSummary record;
        record.x.mean = to_standard_gravity(MilliGal(mean(0)));
        record.y.mean = to_standard_gravity(MilliGal(mean(1)));
        record.z.mean = to_standard_gravity(MilliGal(mean(2)));
        SurveyRow row;
        row.site = "laboratory";
        row.reference = MilliGal(kTumbledGravity_mgal);
        row.temperature = DegC(degc);
        row.record = record;
        read.rows.push_back(row);
    }
    return read;
}

bool is_within(const TumbleTerm& found, double truth) {
    return std::abs(found.value - truth) <= 1.96 * found.standard_error;
}

double slope_of(const Truth& truth) {
    return truth.scale(2) + 2.0 * truth.quadratic(2) * kTumbledGravity_mgal /
                                kMilliGalPerStandardGravity / kMilliGalPerStandardGravity;
}

std::string refusal_of_tumble(const OccupationRows& read) {
    try {
        static_cast<void>(measure_tumble(read, "tumble"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("without noise a tumble gives the sensor it was made with") {
    std::mt19937_64 random(1);
    Truth truth = drawn(random);
    truth.bias = {20000.0, -20000.0, 1838.0};
    const Tumble found = measure_tumble(tumbled(truth, directions(true), random, 0.0), "tumble");
    // The priors pull each term by the share (error / deviation of its prior)^2.
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        CHECK(found.axes[k].bias_mgal.value == Approx(truth.bias(axis)).margin(0.1));
        CHECK(found.axes[k].scale.value == Approx(truth.scale(axis)).epsilon(0).margin(1e-8));
        CHECK(found.axes[k].quadratic_mgal.value == Approx(truth.quadratic(axis)).margin(0.1));
        CHECK(found.angle_rad[k].value == Approx(truth.angle(axis)).epsilon(0).margin(1e-8));
        CHECK(found.axes[k].quadratic_mgal.is_determined);
    }
    REQUIRE(found.axis_bias);
    CHECK(found.axis_bias->values(0) ==
          Approx(truth.bias(0) + truth.angle(1) * kTumbledGravity_mgal).margin(0.2));
}

TEST_CASE("in twenty tumbles the limits contain the truth of each term in seventeen") {
    constexpr int kTumbles = 20, kLeast = 17;
    std::array<std::array<int, 4>, 3> within{};
    int slopes = 0, biases = 0;
    for (int seed = 1; seed <= kTumbles; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Truth truth = drawn(random);
        const Tumble found = measure_tumble(tumbled(truth, directions(true), random), "tumble");
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            within[k][0] += is_within(found.axes[k].bias_mgal, truth.bias(axis));
            within[k][1] += is_within(found.axes[k].scale, truth.scale(axis));
            within[k][2] += is_within(found.axes[k].quadratic_mgal, truth.quadratic(axis));
            within[k][3] += is_within(found.angle_rad[k], truth.angle(axis));
        }
        slopes += is_within(found.slope, slope_of(truth));
        const unit::AxisBias& bias = found.axis_bias.value();
        biases +=
            std::abs(bias.values(0) - truth.bias(0) - truth.angle(1) * kTumbledGravity_mgal) <=
            1.96 * std::sqrt(bias.covariance(0, 0));
        CHECK(found.slope.standard_error < 3e-5);
    }
    for (const auto& axis : within)
        for (const int count : axis) CHECK(count >= kLeast);
    CHECK(slopes >= kLeast);
    CHECK(biases >= kLeast);
    std::printf("bias, scale, quadratic, angle within 95 %% limits of 20:");
    for (const auto& axis : within)
        std::printf("  %d %d %d %d", axis[0], axis[1], axis[2], axis[3]);
    std::printf("; scale of the reading %d, bias of x at level %d\n", slopes, biases);
}

TEST_CASE(
    "six positions give the scale between up and down and leave the quadratic term to the prior") {
    int within = 0, slopes = 0;
    for (std::uint64_t seed = 101; seed <= 120; ++seed) {
        std::mt19937_64 random(seed);
        const Truth truth = drawn(random);
        const Tumble found = measure_tumble(tumbled(truth, directions(false), random), "tumble");
        const TumbleAxis& z = found.axes[2];
        CHECK(z.scale.is_determined);
        // Askew by 0.01 rad, with angles between the axes that are known to 3 mrad.
        CHECK(z.scale.standard_error < 2.0 * 0.01 * 3e-3);
        CHECK(z.zero_mgal.is_determined);
        CHECK_FALSE(z.quadratic_mgal.is_determined);
        CHECK_FALSE(z.bias_mgal.is_determined);
        CHECK_FALSE(found.angle_rad[0].is_determined);
        CHECK_FALSE(found.slope.is_determined);
        CHECK_FALSE(found.axis_bias);
        CHECK(found.scale.standard_error ==
              Approx(2.0 * 300.0 / kMilliGalPerStandardGravity).epsilon(0.05));
        within += is_within(z.scale, truth.scale(2));
        slopes += is_within(found.slope, slope_of(truth));
    }
    CHECK(within >= 17);
    CHECK(slopes >= 17);
    std::printf("six positions: scale of z within 95 %% limits in %d of 20, of the reading in %d\n",
                within, slopes);
}

TEST_CASE("tumbles at three temperatures give the changes of bias and scale with right errors") {
    const int units = test::is_long() ? 100 : 20;
    const double most_off = test::is_long() ? 0.15 : 0.35;  // two standard errors of a ratio
    Eigen::Array4d squares = Eigen::Array4d::Zero();
    double of_share = 0.0, u_share = 0.0;
    for (int seed = 1; seed <= units; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(200 + seed));
        std::normal_distribution<double> normal;
        Truth truth = drawn(random);
        for (Eigen::Index k = 0; k < 3; ++k) {
            truth.bias_by_degc(k) = -20.0 + 5.0 * normal(random);
            truth.scale_by_degc(k) = -10.0 + 5.0 * normal(random);
        }
        OccupationRows all;
        for (const double degc : {20.0, 30.0, 42.5}) {
            const OccupationRows read = tumbled(truth, directions(true), random, 1.7, degc);
            CHECK_FALSE(measure_tumble(read, "one temperature").faces);
            all.rows.insert(all.rows.end(), read.rows.begin(), read.rows.end());
        }
        const Tumble found = measure_tumble(all, "tumbles");
        REQUIRE(found.faces);
        const double in_g = kTumbledGravity_mgal / kMilliGalPerStandardGravity;
        Eigen::Vector4d expected;
        expected << truth.bias(2) + truth.quadratic(2) * in_g * in_g,
            (truth.scale(2) - 1.0) * kMilliGalPerStandardGravity, truth.bias_by_degc(2),
            truth.scale_by_degc(2);
        squares += (found.faces->values - expected).array().square() /
                   found.faces->covariance.diagonal().array();
        const unit::ScaleShare share = unit::scale_share_of(*found.faces);
        CHECK(share.is_measured);
        of_share +=
            std::pow((share.mean - expected(3) / (expected(2) + expected(3))) / share.deviation, 2);
        u_share = std::max(u_share, share.deviation);
    }
    const Eigen::Array4d ratios = (squares / units).sqrt();
    for (const double ratio : ratios) CHECK(std::abs(ratio - 1.0) < most_off);
    CHECK(std::abs(std::sqrt(of_share / units) - 1.0) < most_off);
    CHECK(u_share < 0.02);
    std::printf(
        "%d units at 20, 30, 42.5 degC, error over u: bias %.2f, scale %.2f, by degC %.2f, %.2f, "
        "share of the scale %.2f (u at most %.4f)\n",
        units, ratios(0), ratios(1), ratios(2), ratios(3), std::sqrt(of_share / units), u_share);
}

TEST_CASE("a wrong gravity within its uncertainty is within that of the scale") {
    std::mt19937_64 random(1);
    const Truth truth = drawn(random);
    OccupationRows read = tumbled(truth, directions(true), random);
    for (SurveyRow& row : read.rows) {
        row.reference = MilliGal(kTumbledGravity_mgal + 40.0);
        row.u_reference = MilliGal(40.0);
    }
    const Tumble found = measure_tumble(read, "tumble");
    CHECK(found.axes[0].scale.standard_error == Approx(40.0 / kTumbledGravity_mgal).epsilon(0.1));
    CHECK(is_within(found.axes[0].scale, truth.scale(0)));
}

TEST_CASE("positions that disagree enlarge the limits") {
    // The last one is that of a sensor of the kind in a telephone.
    const double noise_mgal = GENERATE(50.0, 12000.0);
    INFO("noise " << noise_mgal << " mGal");
    const int count = 20;
    double squares = 0.0, residuals = 0.0;
    for (int seed = 1; seed <= count; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Truth truth = drawn(random);
        const Tumble found =
            measure_tumble(tumbled(truth, directions(true), random, noise_mgal), "tumble");
        for (std::size_t k = 0; k < 3; ++k)
            squares += std::pow((found.axes[k].scale.value - truth.scale(Eigen::Index(k))) /
                                    found.axes[k].scale.standard_error,
                                2);
        residuals += std::pow(found.residual_mgal.value() / noise_mgal, 2) / count;
    }
    CHECK(std::sqrt(squares / (3 * count)) == Approx(1.0).margin(0.3));
    CHECK(std::sqrt(residuals) == Approx(1.0).margin(0.2));
}

TEST_CASE("a tumble that cannot be measured is refused with the reason") {
    std::mt19937_64 random(1);
    const Truth truth = drawn(random);
    const OccupationRows good = tumbled(truth, directions(false), random);
    CHECK(refusal_of_tumble(good) == "accepted");
    OccupationRows bad = good;
    bad.rows[3].is_flagged = true;
    CHECK_THAT(refusal_of_tumble(bad), ContainsSubstring("no position with y down"));
    bad = good;
    bad.rows[1].site = "elsewhere";
    CHECK_THAT(refusal_of_tumble(bad), ContainsSubstring("one point"));
    bad = good;
    bad.rows[0].reference.reset();
    CHECK_THAT(refusal_of_tumble(bad), ContainsSubstring("gravity_mgal"));
}
