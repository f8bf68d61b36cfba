#include "corrector/model/whole_day_model.hpp"

#include "tests/unit/model/corrections.hpp"
#include "tests/unit/model/rows_of_day.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

/// Student's t with 10 degrees of freedom at 0.05 / 26: 13 readings of a clean day are below it.
constexpr double kLimit = 3.74;

}  // namespace

TEST_CASE("auto chooses the whole-day model if the records allow it") {
    const DayRecord day = kScattered.record();
    const auto rows = rows_of(day);
    const auto result = correct_survey(rows, by_model("auto"), &day);
    CHECK(result.model == "day");
    CHECK(result.score.row_count == rows.size());
    CHECK(result.score.rms_mgal.value() < result.score.loso_mgal.value());
    CHECK(result.score.loso_mgal.value() < 2.0);
    CHECK(correct_survey(rows, by_model("auto"), nullptr).model != "day");
}

TEST_CASE(
    "corrections of the whole-day model add up to the corrected value of each row, and a row "
    "of a station occupied twice is less certain than the station") {
    const DayRecord day = kScattered.record();
    const auto result = correct_survey(rows_of(day), by_model("day"), &day);
    for (const CorrectedRow& row : result.rows) {
        CHECK(row.tilt_correction);
        CHECK(row.scale_correction);
        CHECK(row.as<WholeDayRow>() != nullptr);
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(1e-12));
    }
    for (const StationValue& station : result.stations)
        for (const CorrectedRow& row : result.rows) {
            if (row.row.site != station.site) continue;
            if (station.row_count == 1)
                CHECK(*row.u_corrected == *station.u_gravity);
            else
                CHECK(row.u_corrected->value() > 1.1 * station.u_gravity->value());
        }
}

TEST_CASE("the value predicted without a station is the value found when its reference is hidden") {
    const DayRecord day = kScattered.record();
    const auto rows = rows_of(day);
    const auto all = correct_survey(rows, by_model("day"), &day);
    for (const std::string site : {"S3", "S7"}) {
        auto hidden = rows;
        for (SurveyRow& row : hidden)
            if (row.site == site) row.reference.reset();
        const auto result = correct_survey(hidden, by_model("day"), &day);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].site != site) continue;
            CHECK(result.rows[i].corrected.value() ==
                  Approx(all.rows[i].as<WholeDayRow>()->left_out.value().value()).margin(0.01));
            CHECK(result.rows[i].u_corrected->value() ==
                  Approx(all.rows[i].u_corrected->value()).epsilon(0.01));
            CHECK_FALSE(result.rows[i].residual);
        }
        CHECK(station(result, site).gravity.value() == Approx(gravity_of(site)).margin(4.0));
    }
}

TEST_CASE("a flagged row has a value and no influence on the others") {
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    rows[6].is_flagged = true;
    const auto result = correct_survey(rows, by_model("day"), &day);
    CHECK_FALSE(result.rows[6].is_used);
    CHECK(result.score.row_count == rows.size() - 1);
    rows[6].reference = *rows[6].reference + MilliGal(1000.0);
    const auto other = correct_survey(rows, by_model("day"), &day);
    for (std::size_t i = 0; i < rows.size(); ++i)
        CHECK(other.rows[i].corrected.value() ==
              Approx(result.rows[i].corrected.value()).epsilon(1e-12));
    CHECK(result.row_sets.back().scores.back().row_count == rows.size());
}

TEST_CASE(
    "a blunder alone has a large studentised residual, in the fit or not, and a clean day "
    "has none") {
    DayRecord day = kScattered.record();
    const auto large = [&] {
        const auto result = correct_survey(rows_of(day), by_model("day"), &day);
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < result.rows.size(); ++i)
            if (std::abs(result.rows[i].studentised_residual.value()) > kLimit) found.push_back(i);
        return found;
    };
    CHECK(large().empty());
    add(day, 8, 15.0);
    CHECK(large() == std::vector<std::size_t>{8});

    auto rows = rows_of(day);
    rows[8].is_flagged = true;
    CHECK(correct_survey(rows, by_model("day"), &day).rows[8].studentised_residual.value() > 5.0);
}

TEST_CASE("excluded rows do not influence each other") {
    // Two rows of one station are excluded; their difference contains information on the drift.
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    for (const std::size_t i : {1U, 12U}) rows[i].is_excluded = true;
    const auto result = correct_survey(rows, by_model("day"), &day);
    CHECK(result.score.row_count == rows.size() - 2);
    CHECK(result.rows[1].u_corrected);
    CHECK(station(result, "S1").is_flagged_only);
    CHECK(station(result, "S1").row_count == 2);
    rows[12].is_excluded = false;
    const auto one = correct_survey(rows, by_model("day"), &day);
    CHECK_FALSE(station(one, "S1").is_flagged_only);
    CHECK(station(one, "S1").row_count == 1);
    CHECK(station(one, "S1").gravity == one.rows[12].corrected);
    rows[12].is_excluded = true;
    DayRecord other = day;
    add(other, 12, 500.0);
    const auto changed = correct_survey(rows, by_model("day"), &other);
    CHECK(changed.rows[1].corrected.value() ==
          Approx(result.rows[1].corrected.value()).epsilon(0.0).margin(0.01));
    CHECK(changed.rows[12].corrected.value() ==
          Approx(result.rows[12].corrected.value() + 500.0 / changed.scales.front().value)
              .epsilon(0.0)
              .margin(0.01));
}

TEST_CASE("if all rows are flagged, the whole-day model is scored only with the flags ignored") {
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    for (SurveyRow& row : rows) row.is_flagged = true;
    SurveyOptions options = by_model("day");
    options.use_flags = false;
    const auto result = correct_survey(rows, options, &day);
    CHECK(result.row_sets.front().scores.back().model != "day");
    CHECK(result.row_sets.back().scores.back().model == "day");
}

TEST_CASE("the reason why auto does not use the whole-day model is reported") {
    DayRecord day = kScattered.record();
    const auto rows = rows_of(day);
    SurveyOptions options = by_model("day");
    set_prior(options.priors, "test", "temperature_mgal_per_degc", {-30.0, 1.0});
    CHECK_THROWS_WITH(correct_survey(rows, options, &day), ContainsSubstring("its own priors"));
    day.temperature.gaps = {{1000, 13000}};
    const auto result = correct_survey(rows, by_model("auto"), &day);
    CHECK(result.model != "day");
    REQUIRE_FALSE(result.remarks.empty());
    CHECK_THAT(result.remarks.front(),
               ContainsSubstring("not the whole-day model: the temperature"));
}

TEST_CASE("auto says what the whole-day model was compared with, or that nothing was") {
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    const auto all = correct_survey(rows, by_model("auto"), &day);
    REQUIRE(all.model == "day");
    CHECK_THAT(all.remarks.at(0), ContainsSubstring("the whole-day model is used: its error at "
                                                    "stations left out is"));
    know_only(rows, {"S0"});
    const auto one = correct_survey(rows, by_model("auto"), &day);
    REQUIRE(one.model == "day");
    CHECK_THAT(one.remarks.at(0),
               ContainsSubstring("not compared with others (that needs enough readings at 3 known "
                                 "stations); its fit"));
}

TEST_CASE("the uncertainties of a day that the model does not fit are enlarged") {
    DayRecord day = kScattered.record();
    const auto rows = rows_of(day);
    const auto fits = correct_survey(rows, by_model("day"), &day);
    CHECK(remark(fits, "the model does not fit this day").empty());
    add(day, 5, 25.0);
    const auto misfit = correct_survey(rows, by_model("day"), &day);
    CHECK_THAT(remark(misfit, "the model does not fit this day"),
               ContainsSubstring("differences are enlarged by "));
    double squares = 0.0;
    for (const CorrectedRow& row : misfit.rows) squares += std::pow(*row.studentised_residual, 2);
    const double factor = misfit.as<WholeDayPart>()->uncertainty_factor;
    CHECK(factor == Approx(std::sqrt(squares / static_cast<double>(misfit.rows.size()))));
    CHECK(factor > 2.0);
    // It still looks as bad as it is.
    CHECK(std::abs(*misfit.rows[5].studentised_residual) > kLimit);
    for (const StationValue& station : misfit.stations) {
        double sum = 0.0;
        for (const double part : station.parts_mgal.value()) sum += part * part;
        CHECK(std::sqrt(sum) == Approx(station.u_gravity->value()).epsilon(1e-9));
    }
    CHECK(misfit.stations[8].u_gravity->value() ==
          Approx(factor * misfit.rows[8].u_corrected->value()).epsilon(1e-9));
}

TEST_CASE("a bad reading has a large studentised residual although only four stations are known") {
    DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    know_only(rows, {"S0", "S3", "S6", "S9"});
    for (const double error_mgal : {0.0, 30.0}) {
        add(day, 6, error_mgal);
        const auto result = correct_survey(rows, by_model("day"), &day);
        CHECK(result.score.dof == 0);
        const double t = std::abs(result.rows[6].studentised_residual.value());
        CHECK((t > kLimit) == (error_mgal != 0.0));
    }
}

TEST_CASE("the residual of a reference counts in units of both uncertainties") {
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    for (SurveyRow& row : rows)
        if (row.site == rows[8].site) {
            row.reference = *row.reference + MilliGal(12.0);
            row.u_reference = MilliGal(10.0);
        }
    const auto result = correct_survey(rows, by_model("day"), &day);
    const CorrectedRow& loose = result.rows[8];
    const double off = (*loose.as<WholeDayRow>()->left_out - *loose.row.reference).value();
    CHECK(off == Approx(-12.0).margin(4.0));
    CHECK(*loose.studentised_residual ==
          Approx(off / std::hypot(10.0, loose.u_corrected->value())));
    CHECK(std::abs(*loose.studentised_residual) < kLimit);
}

TEST_CASE("one reading at a known station is enough for the whole-day model") {
    const DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    for (std::size_t i = 1; i < rows.size(); ++i) rows[i].reference.reset();
    for (const char* const name : {"auto", "network"}) {
        const auto result = correct_survey(rows, by_model(name), &day);
        CHECK(result.model == "day");
        CHECK(result.score.row_count == 1);
        CHECK_FALSE(result.score.loso_mgal);
        for (const StationValue& station : result.stations) {
            if (station.reference) continue;
            CHECK(std::abs(station.gravity.value() - gravity_of(station.site)) <
                  3.0 * station.u_gravity->value());
            CHECK(station.u_gravity->value() < 8.0);
        }
    }
    CHECK(correct_survey(rows, by_model("network"), nullptr).model == "network");
}

TEST_CASE("after a gap of the temperature, estimating the state of the lags halves the error") {
    DayRecord day = MadeUpDay{}.record();
    const auto rows = rows_of(day);
    // Between the seventh and the eighth set-up the temperature was another one than the line, and
    // its slow effect remains.
    const TemperatureGap gap{9250, 9890};
    const UtcTime end = day.temperature.series.time_of(static_cast<double>(gap.after));
    for (DayBin& bin : day.bins)
        if (bin.time > end)
            bin.reading =
                bin.reading + MilliGal(1.0 * std::exp(-seconds_between(end, bin.time) / 2200.0));
    const double believed = *correct_survey(rows, by_model("day"), &day).score.loso_mgal;
    day.temperature.gaps = {gap};
    const double estimated = *correct_survey(rows, by_model("day"), &day).score.loso_mgal;
    CAPTURE(believed, estimated);
    CHECK(estimated < 0.5 * believed);
}

TEST_CASE("auto leaves the whole-day model if a simpler one predicts stations better") {
    DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    // The rows' means are those of a plain instrument, the bins are of something else.
    for (SurveyRow& row : rows)
        row.acceleration =
            *row.reference + MilliGal(1838.0) - MilliGal(30.0 * (row.temperature.value() - 42.6));
    CHECK(correct_survey(rows, by_model("auto"), &day).model != "day");
    for (std::size_t i = 0; i < day.bins.size(); ++i)
        day.bins[i].reading =
            day.bins[i].reading + MilliGal(i / MadeUpDay::kBins == 5 ? 200.0 : 0.0);
    const auto result = correct_survey(rows, by_model("auto"), &day);
    CHECK(result.model == "t");
    REQUIRE_FALSE(result.remarks.empty());
    CHECK_THAT(result.remarks.front(),
               ContainsSubstring("not the whole-day model: its error at stations left out is"));
    CHECK(correct_survey(rows, by_model("day"), &day).model == "day");
    rows = rows_of(kScattered.record());
    const DayRecord good = kScattered.record();
    CHECK(correct_survey(rows, by_model("auto"), &good).model == "day");
}

TEST_CASE("a day that does not determine the whole-day model is refused with its reason") {
    DayRecord day = kScattered.record();
    auto rows = rows_of(day);
    CHECK_THROWS_WITH(correct_survey(rows, by_model("day"), nullptr),
                      ContainsSubstring("model = day: needs the record of the day's temperature"));
    for (SurveyRow& row : rows) row.reference.reset();
    CHECK_THROWS_WITH(correct_survey(rows, by_model("day"), &day),
                      ContainsSubstring("needs a row with a reference, has none"));
    rows = rows_of(day);
    day.temperature.gaps = {{1000, 13000}};
    CHECK_THROWS_WITH(correct_survey(rows, by_model("day"), &day),
                      ContainsSubstring("has a gap of 400 min, more than the allowed 360"));
    day.temperature.gaps.clear();
    std::erase_if(day.bins, [](const DayBin& bin) { return bin.set_up == 4; });
    CHECK_THROWS_WITH(correct_survey(rows, by_model("day"), &day), ContainsSubstring("S4 (1) has"));
}

TEST_CASE("a temperature that begins late gives a remark") {
    DayRecord day = kScattered.record();
    CHECK(correct_survey(rows_of(day), by_model("day"), &day).remarks.empty());
    const auto& whole = day.temperature.series;
    day.temperature.series = {
        whole.time_of(2000.0), whole.rate(),
        std::vector<double>(whole.values().begin() + 2000, whole.values().end())};
    const auto remarks = correct_survey(rows_of(day), by_model("day"), &day).remarks;
    REQUIRE(remarks.size() == 1);
    CHECK_THAT(remarks.front(), ContainsSubstring("begins 54 min before the first occupation"));
}

TEST_CASE("in two faces the prior of a calibrated scale is wider") {
    const auto prior_with = [](bool has_two_faces) {
        MadeUpDay made_up = kScattered;
        made_up.has_two_faces = has_two_faces;
        const DayRecord day = made_up.record();
        SurveyOptions options = by_model("day");
        options.calibration.emplace();
        options.calibration->scale = {1.0, 1e-5};
        const auto result = correct_survey(rows_of(day), options, &day);
        const auto scale = coefficient(result, "scale").prior.value();
        CHECK(scale.sd == result.scales.at(0).prior.sd);
        return scale.sd;
    };
    CHECK(prior_with(false) == Approx(1e-5));
    CHECK(prior_with(true) == Approx(6.1e-4).epsilon(0.01));
}

TEST_CASE("a report says whether turning the box over pays on this unit") {
    const auto remark_with = [](double share) {
        const DayRecord day = MadeUpDay{.placement_mgal = 1.2,
                                        .white_mgal = 0.2,
                                        .has_two_faces = true,
                                        .scale_share = share}
                                  .record();
        auto rows = rows_of(day);
        for (std::size_t s = 0; s < rows.size(); ++s)
            rows[s].face = day.bins[s * MadeUpDay::kBins].face < 0.0 ? -1 : 1;
        const auto result = correct_survey(rows, by_model("day"), &day);
        return remark(result, "8 of 16 set-ups were turned over");
    };
    CHECK_THAT(remark_with(0.2), EndsWith(": turning pays on this unit"));
    CHECK_THAT(remark_with(0.7), EndsWith("which turning does not cancel"));
    CHECK_THAT(remark_with(1.0), EndsWith(": turning does not pay on this unit"));
}
