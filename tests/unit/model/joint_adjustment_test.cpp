#include "corrector/model/joint_adjustment.hpp"

#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/rows_of_day.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

/// A day and its correction by a model.
struct Corrected {
    DayRecord day;
    SurveyCorrection result;
};

Corrected corrected(std::uint64_t seed, const std::string& model = "day",
                    double moved_reference_mgal = 0.0) {
    const MadeUpDay made_up{.placement_mgal = 1.2, .white_mgal = 0.2};
    Corrected one{made_up.record(seed), {}};
    auto rows = rows_of(one.day);
    for (SurveyRow& row : rows) {
        if (row.site == "S9") row.reference.reset();
        if (row.site == "S4") row.reference = *row.reference + MilliGal(moved_reference_mgal);
        if (row.site == "S7") row.is_flagged = true;
    }
    SurveyOptions options;
    options.model = model;
    one.result = correct_survey(rows, options, &one.day);
    return one;
}

}  // namespace

TEST_CASE("two units at one time are one box, and each station has one gravity",
          "[survey][joint]") {
    const Corrected a = corrected(1), b = corrected(2);
    const auto joint =
        adjust_jointly({{"a", "1", &a.result, &a.day}, {"b", "2", &b.result, &b.day}});
    REQUIRE(std::holds_alternative<JointAdjustment>(joint));
    const auto& adjustment = std::get<JointAdjustment>(joint);
    CHECK(adjustment.units.size() == 2);
    CHECK(adjustment.share);
    // S7 has marked readings only.
    REQUIRE(adjustment.stations.size() == 10);
    CHECK(adjustment.differences.size() == 45);
    for (const JointGravity& station : adjustment.stations) {
        const auto number = static_cast<std::size_t>(std::stoi(station.site.substr(1)));
        CHECK(std::abs(station.gravity.value() - MadeUpDay::gravity_mgal(number)) <
              4.0 * station.u.value());
        CHECK_FALSE(station.is_in_sample);
    }
    for (Eigen::Index k = 0; k < 10; ++k)
        CHECK(std::sqrt(adjustment.covariance.mgal2(k, k)) ==
              Approx(adjustment.stations[static_cast<std::size_t>(k)].u.value()));
}

TEST_CASE("without a serial number each day is a unit of its own", "[survey][joint]") {
    const Corrected a = corrected(1), b = corrected(2);
    DayRecord later = b.day;
    const auto one_day = std::chrono::hours(24);
    const TimeSeries<DegC>& degc = b.day.temperature.series;
    later.temperature.series = TimeSeries<DegC>(degc.start() + one_day, degc.rate(), degc.values());
    for (DayBin& bin : later.bins) {
        bin.time += one_day;
        for (UtcTime& time : bin.times) time += one_day;
    }
    const auto units = [&](const std::string& serial) {
        const auto joint =
            adjust_jointly({{"a", serial, &a.result, &a.day}, {"b", serial, &b.result, &later}});
        return std::get<JointAdjustment>(joint).units.size();
    };
    CHECK(units("1") == 1);
    CHECK(units("") == 2);
}

TEST_CASE("surveys that cannot be adjusted together are refused with the reason",
          "[survey][joint]") {
    const Corrected a = corrected(1), linear = corrected(2, "t"), moved = corrected(2, "day", 3.0);
    const auto reason = [&](const Corrected& other, const std::string& serial) {
        return std::get<text::Message>(adjust_jointly(
            {{"a", "1", &a.result, &a.day}, {"b", serial, &other.result, &other.day}}));
    };
    CHECK(reason(linear, "2") == "b is not corrected by the whole-day model");
    CHECK(reason(moved, "2") ==
          "the surveys have different references of S4, or different uncertainties of it");
    CHECK(reason(moved, "1") == "a and b are of one unit (1) at the same time");
}
