#include "corrector/reading/decimated_axes.hpp"

#include "tests/unit/reading/record.hpp"

using namespace a351::signal;

namespace a351::corrector::reading {
namespace {

/// Returns the mean of the valid outputs minus gravity, for axes that vibrate sideways.
double bias_mgal(NormOrder order, double rms_gal) {
    const OccupationRecord record{
        vibrating_axis(60'000, 0.0, rms_gal, 7.3), vibrating_axis(60'000, 0.0, rms_gal, 11.9),
        vibrating_axis(60'000, 1.0, 0.0, 1.0), TimeSeries<DegC>(kSiteStart, Hertz(50.0), {})};
    const auto result = gravity_series(record, decimate_axes(record), order);
    double sum = 0.0;
    for (std::size_t k = 5; k <= 595; ++k) sum += result.values()[k] - 980'665.0;
    return sum / 591.0;
}

}  // namespace

TEST_CASE("sideways vibration makes the norm of raw samples too large by the rectification bias") {
    for (const double rms_gal : {1.0, 2.0}) {
        const MilliGal rms(1000.0 * rms_gal);
        const double expected = rectification_bias(rms, rms, MilliGal(980'665.0)).value();
        CHECK(expected == Approx(1.02 * rms_gal * rms_gal).margin(0.01));
        CHECK(bias_mgal(NormOrder::as_published, rms_gal) == Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("the norm of decimated axes is free of the rectification bias") {
    CHECK(std::abs(bias_mgal(NormOrder::decimate_first, 1.0)) < 1e-4);
}

}  // namespace a351::corrector::reading
