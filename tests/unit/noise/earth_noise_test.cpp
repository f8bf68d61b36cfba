#include "corrector/noise/earth_noise.hpp"

#include <cmath>
#include <utility>

#include "tests/support/catch.hpp"

using namespace a351::corrector::noise;

namespace {

double level_db(GroundNoise model, double period_s) {
    return 20.0 * std::log10(1e-5 * ground_noise_mgal_per_sqrt_hz(model, period_s));
}

}  // namespace

// Levels: P. Bormann (ed.), New Manual of Seismological Observatory Practice, 2012, table 4.2.
TEST_CASE("the noise of the ground has the published levels at its corners") {
    using Corner = std::pair<double, double>;
    for (const auto& [period_s, db] :
         {Corner{0.10, -168.0},  Corner{0.17, -166.7},  Corner{0.40, -166.7},
          Corner{0.80, -169.2},  Corner{1.24, -163.7},  Corner{2.40, -148.6},
          Corner{4.30, -141.1},  Corner{5.00, -141.1},  Corner{6.00, -149.0},
          Corner{10.0, -163.8},  Corner{12.0, -166.2},  Corner{15.6, -162.1},
          Corner{21.9, -177.5},  Corner{31.6, -185.0},  Corner{45.0, -187.5},
          Corner{70.0, -187.5},  Corner{101.0, -185.0}, Corner{154.0, -185.0},
          Corner{328.0, -187.5}, Corner{600.0, -184.4}, Corner{1e4, -151.9},
          Corner{1e5, -103.1}})
        CHECK(std::abs(level_db(GroundNoise::low, period_s) - db) < 0.1);
    for (const auto& [period_s, db] :
         {Corner{0.10, -91.5}, Corner{0.22, -97.4}, Corner{0.32, -110.5}, Corner{0.80, -120.0},
          Corner{3.80, -98.0}, Corner{4.60, -96.5}, Corner{6.30, -101.0}, Corner{7.90, -113.5},
          Corner{15.4, -120.0}, Corner{20.0, -138.5}, Corner{354.8, -126.0}, Corner{1e5, -48.5}})
        CHECK(std::abs(level_db(GroundNoise::high, period_s) - db) < 0.1);
    CHECK(std::isnan(ground_noise_mgal_per_sqrt_hz(GroundNoise::low, 0.09)));
    CHECK(std::isnan(ground_noise_mgal_per_sqrt_hz(GroundNoise::high, 1.1e5)));
}

TEST_CASE("the parts of the noise of the ground meet") {
    for (const auto model : {GroundNoise::low, GroundNoise::high})
        for (double period_s = 0.1; period_s < 9e4; period_s *= 1.001)
            CHECK(std::abs(level_db(model, 1.001 * period_s) - level_db(model, period_s)) < 0.3);
}
