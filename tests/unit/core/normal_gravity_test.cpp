#include "protocol/core/normal_gravity.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "tests/support/catch.hpp"

using namespace a351;

namespace {

/// Returns the gravity of GRS80 at a point, mGal: the gradient of its exact potential in ellipsoidal
/// coordinates u, beta.  Source: W. A. Heiskanen and H. Moritz, Physical Geodesy, 1967, section 2-7.
double exact_gravity_mgal(double latitude_deg, double height_m) {
    constexpr double a = 6378137.0, gm = 3986005e8, omega = 7292115e-11, f = 0.00335281068118;
    const double b = a * (1.0 - f), e2 = a * a - b * b, e = std::sqrt(e2);  // linear eccentricity
    const double phi = latitude_deg / 180.0 * std::numbers::pi;
    const double n = a * a / std::hypot(a * std::cos(phi), b * std::sin(phi));
    const double r = (n + height_m) * std::cos(phi);
    const double z = (n * b * b / (a * a) + height_m) * std::sin(phi);
    const double d = r * r + z * z - e2;
    const double u = std::sqrt(0.5 * d * (1.0 + std::sqrt(1.0 + 4.0 * e2 * z * z / (d * d))));
    const double ue2 = u * u + e2;
    const double beta = std::atan2(z * std::sqrt(ue2), u * r);
    const double sine = std::sin(beta), cosine = std::cos(beta);
    const auto q_of = [e](double at) {
        return 0.5 * ((1.0 + 3.0 * at * at / (e * e)) * std::atan(e / at) - 3.0 * at / e);
    };
    const double q0 = q_of(b), q = q_of(u);
    const double q_prime = 3.0 * (1.0 + u * u / e2) * (1.0 - u / e * std::atan(e / u)) - 1.0;
    const double w = std::sqrt((u * u + e2 * sine * sine) / ue2);
    const double wa = omega * omega * a * a;
    const double along_u =
        (gm / ue2 + wa * e / ue2 * q_prime / q0 * (0.5 * sine * sine - 1.0 / 6.0) -
         omega * omega * u * cosine * cosine) /
        w;
    const double along_beta =
        (-wa * q / (std::sqrt(ue2) * q0) + omega * omega * std::sqrt(ue2)) * sine * cosine / w;
    return 1e5 * std::hypot(along_u, along_beta);
}

double gravity_mgal(double latitude_deg) { return normal_gravity(Degrees(latitude_deg)).value(); }
double gravity_mgal(double latitude_deg, double height_m) {
    return normal_gravity(Degrees(latitude_deg), Metres(height_m)).value();
}

/// Returns the largest difference between the series and the exact gravity at a height.
double largest_error_mgal(double height_m) {
    double largest = 0.0;
    for (double latitude_deg = -90.0; latitude_deg <= 90.0; latitude_deg += 1.0)
        largest = std::max(largest, std::abs(gravity_mgal(latitude_deg, height_m) -
                                             exact_gravity_mgal(latitude_deg, height_m)));
    std::printf("normal gravity at %.0f m: at most %.5f mGal from the exact potential\n", height_m,
                largest);
    return largest;
}

}  // namespace

TEST_CASE("normal gravity has the published values of GRS80") {
    // Moritz 2000: gamma_e, gamma_45 and gamma_p.
    CHECK(gravity_mgal(0.0) == Approx(978032.67715).epsilon(0.0).margin(0.00005));
    CHECK(gravity_mgal(45.0) == Approx(980619.9203).epsilon(0.0).margin(0.0001));  // last digit
    CHECK(gravity_mgal(90.0) == Approx(983218.63685).epsilon(0.0).margin(0.00005));
    CHECK(gravity_mgal(-45.0) == gravity_mgal(45.0));
    CHECK(gravity_mgal(36.0, 0.0) == gravity_mgal(36.0));
    CHECK(gravity_mgal(45.0) - gravity_mgal(45.0, 1.0) == Approx(0.3086).margin(0.00005));
}

TEST_CASE("normal gravity agrees with the gradient of the exact potential") {
    CHECK(largest_error_mgal(0.0) < 0.00001);
    CHECK(largest_error_mgal(-500.0) < 0.006);
    CHECK(largest_error_mgal(1000.0) < 0.011);
    CHECK(largest_error_mgal(3000.0) < 0.03);
    CHECK(largest_error_mgal(9000.0) < 0.07);
}

TEST_CASE("a latitude or height that is not a number gives no gravity") {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(gravity_mgal(kNaN)));
    CHECK(std::isnan(gravity_mgal(45.0, kNaN)));
}
