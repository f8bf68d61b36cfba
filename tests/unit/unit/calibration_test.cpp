#include "protocol/unit/calibration.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/unit/combined_estimates.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::unit;

namespace {

Calibration whole() {
    Calibration calibration;
    calibration.serial_number = "A \"7\"\\\x7f";
    calibration.program = "a351-correct 0.1";
    calibration.valid_from = *parse_rfc3339("2026-03-01T01:02:03.123456789Z");
    calibration.valid_to = *parse_rfc3339("2027-03-01T00:00:00Z");
    calibration.data = {{"XX.A351.00.BNZ.D.2026.060", std::string(64, 'a')},
                        {"events, 2026-03", std::string(64, '0')}};
    calibration.axis_bias.emplace();
    calibration.axis_bias->values << -1234.5678901234567, 1.0 / 3.0;
    calibration.axis_bias->covariance << 311.1, -1e-17, -1e-17, 2e-3;
    calibration.thermal.emplace();
    calibration.thermal->values << -12.0, -20.1, 11.3, 3.76, 7.9;
    calibration.thermal->covariance = 0.1 * Eigen::Matrix<double, 5, 5>::Identity();
    calibration.thermal->covariance(3, 1) = calibration.thermal->covariance(1, 3) = 0.07;
    calibration.warm_up = WarmUpGuidance{0.5, 7.25};
    calibration.placement = Placement{1.1, 0.8, 1.0 / 0.7};
    calibration.scale = Scale{1.0 + 1.0 / 300.0, 1.0 / 7000.0};
    calibration.faces.emplace();
    calibration.faces->values << 1838.0, -300.1, -21.0, -9.0;
    calibration.faces->covariance = 0.01 * Eigen::Matrix4d::Identity();
    return calibration;
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
    const auto at = text.find(old);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old.size(), with);
}

std::string refusal_of(const std::string& text) {
    try {
        static_cast<void>(parse_calibration(text, "c.toml"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("a calibration is bit-identical after writing and reading") {
    const Calibration calibration = whole();
    CHECK(parse_calibration(to_toml(calibration), "c.toml") == calibration);

    Calibration least;
    least.serial_number = "1";
    least.program = "p";
    least.axis_bias.emplace();
    CHECK(parse_calibration(to_toml(least), "c.toml") == least);
}

TEST_CASE("invalid values in a calibration are refused with file, line and key") {
    const std::string good = to_toml(whole());
    struct Case {
        std::string old, with, message;
    };
    const std::vector<Case> cases{
        {"format = 1", "format = 2", "c.toml:2: format = 2: out of range"},
        {"format = 1\n", "", "format: missing"},
        {"serial_number", "serial", "serial_number: missing"},
        {"2026-03-01T01", "2026-03-01 at 1", "not an instant"},
        {"2027-03-01", "2025-03-01", "valid_to_utc"},
        {"\"x_mgal_per_g\", \"y_mgal_per_g\"", "\"y_mgal_per_g\", \"x_mgal_per_g\"",
         "axis_bias.coefficients"},
        {"values = [-12,", "values = [", "]: 4 numbers; allowed: 5 numbers"},
        {"3.76, 7.9", "43, 2700", "thermal.values"},  // seconds instead of their logarithms
        {"3.76, 7.9", "43, 2700", "fast_lag_ln_s = 43: out of range; allowed: 0 to 12"},
        {"3.76, 7.9", "3.76, -0.1", "slow_lag_ln_s = -0.1: out of range"},
        {"-12, -20.1", "-12, -20100", "slow_temperature_mgal_per_degc = -20100: out of range"},
        {"[-1234.5", "[-1234567.5", "x_mgal_per_g = -1234567"},
        {"311.1", "-311.1", "axis_bias.covariance"},
        {"311.1, -1e-17", "311.1, 1e-17", "a symmetric, positive definite matrix"},
        {"within_mgal = 0.5", "within_mgal = nan", "warm_up.within_mgal"},
        {"after_power_on_h", "after_h", "after_power_on_h: missing"},
        {std::string(64, 'a'), "abc", "64 lower-case hexadecimal digits"},
        {"[warm_up]", "[warmth]", "warmth: unknown key"},
        {"limits_mgal = [0.8", "limits_mgal = [1.2", "placement.limits_mgal"},
        {"[scale]\nvalue = 1.0", "[scale]\nvalue = 1.2", "scale.value"},
        {"limits_mgal = [0.8, ", "limits_mgal = [", "two numbers, one below and one above it"},
        {"deviation_mgal = 1.1", "deviation_mgal = 0", "standard_deviation_mgal = 0: out of range"},
        {"standard_deviation_mgal", "sd_mgal", "standard_deviation_mgal: missing"},
    };
    for (const Case& one : cases) {
        CAPTURE(one.old, one.with);
        CHECK_THAT(refusal_of(replaced(good, one.old, one.with)), ContainsSubstring(one.message));
    }
    CHECK_THAT(refusal_of("format = 1\nserial_number = '1'\nprogram = 'p'\n"
                          "valid_from_utc = '2026-01-01T00:00:00Z'\n"),
               ContainsSubstring("axis_bias, thermal, warm_up, placement, scale or faces"));
}

TEST_CASE("SHA-256 of a file agrees with the example of the standard") {
    // FIPS 180-4 examples, "abc".
    const test::TemporaryDirectory folder;
    CHECK(text::sha256_of_file(folder.write("abc", "abc")) ==
          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    // A million times "a": more than one block.
    CHECK(text::sha256_of_file(folder.write("a", std::string(1'000'000, 'a'))) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("independent estimates are combined with weights from their covariances") {
    const AxisBias sharp{{10.0, -4.0}, (Eigen::Matrix2d() << 1.0, 0.5, 0.5, 4.0).finished()};
    CHECK(combined(std::vector{sharp}) == sharp);
    const AxisBias again = combined(std::vector{sharp, sharp, sharp, sharp});
    CHECK((again.values - sharp.values).norm() < 1e-12);
    CHECK((again.covariance - 0.25 * sharp.covariance).norm() < 1e-12);
    // Without correlation each coefficient is a weighted mean: (10 / 1 + 40 / 2) / (1 / 1 + 1 / 2).
    const AxisBias one{{10.0, 0.0}, Eigen::Matrix2d::Identity()},
        other{{40.0, 0.0}, 2.0 * Eigen::Matrix2d::Identity()};
    const AxisBias mean = combined(std::vector{one, other});
    CHECK(mean.values(0) == Approx(20.0));
    CHECK(mean.covariance(0, 0) == Approx(2.0 / 3.0));
}

TEST_CASE("the share of the scale comes from both slopes, or is not known") {
    const ScaleShare share = scale_share_of(*whole().faces);
    CHECK(share.mean == Approx(0.3));
    // (0.7^2 + 0.3^2)^0.5 0.1 / 30
    CHECK(share.deviation == Approx(0.002539).epsilon(1e-3));
    Faces faces = *whole().faces;
    faces.values(3) = 20.9;  // no response together, so every share is possible
    CHECK(scale_share_of(faces) == ScaleShare{});
    CHECK(ScaleShare{}.deviation == Approx(std::sqrt(1.0 / 12.0)));
}
