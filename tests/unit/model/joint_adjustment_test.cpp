#include "corrector/model/joint_adjustment.hpp"

#include "corrector/model/model.hpp"
#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/rows_of_day.hpp"

using namespace a351;
using namespace a351::corrector;
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
    Corrected one{kScattered.record(seed), {}};
    auto rows = rows_of(one.day);
    for (SurveyRow& row : rows) {
        if (row.site == "S9") row.reference.reset();
        if (row.site == "S4") row.reference = *row.reference + MilliGal(moved_reference_mgal);
        if (row.site == "S7") row.is_flagged = true;
    }
    one.result = correct_survey(rows, {.model = model}, model == "day" ? &one.day : nullptr);
    return one;
}

Corrected a_day_later(Corrected one) {
    one.day = later(std::move(one.day), kOneDay);
    for (CorrectedRow& row : one.result.rows) row.row.time += kOneDay;
    return one;
}

}  // namespace

TEST_CASE("two units at one time are one box, and each station has one gravity") {
    const Corrected a = corrected(1), b = corrected(2);
    const auto adjustment = std::get<JointAdjustment>(
        adjust_jointly({{"a", "1", &a.result, &a.day}, {"b", "2", &b.result, &b.day}}));
    CHECK(adjustment.units.size() == 2);
    CHECK(adjustment.share);
    // S7 has marked readings only.
    REQUIRE(adjustment.stations.size() == 10);
    CHECK(adjustment.differences.size() == 45);
    for (const JointGravity& station : adjustment.stations) {
        CHECK(std::abs(station.gravity.value() - gravity_of(station.site)) <
              4.0 * station.u.value());
        CHECK_FALSE(station.is_in_sample);
    }
    for (Eigen::Index k = 0; k < 10; ++k)
        CHECK(std::sqrt(adjustment.covariance.mgal2(k, k)) ==
              Approx(adjustment.stations[static_cast<std::size_t>(k)].u.value()));
}

TEST_CASE("without a serial number each day is a unit of its own") {
    const Corrected a = corrected(1), b = a_day_later(corrected(2));
    const auto units = [&](const std::string& serial) {
        const auto joint =
            adjust_jointly({{"a", serial, &a.result, &a.day}, {"b", serial, &b.result, &b.day}});
        return std::get<JointAdjustment>(joint).units.size();
    };
    CHECK(units("1") == 1);
    CHECK(units("") == 2);
}

TEST_CASE("a day of another model takes part with white noise") {
    const Corrected day = corrected(1);
    for (const std::string model : {"t-drift", "network"}) {
        const Corrected other = a_day_later(corrected(2, model));
        const auto adjustment = std::get<JointAdjustment>(
            adjust_jointly({{"a", "1", &day.result, &day.day},
                            {"b", model == "network" ? "2" : "1", &other.result, nullptr}}));
        CHECK(adjustment.units.size() == 1);
        CHECK_FALSE(adjustment.surveys.front().coefficients.empty());
        CHECK(adjustment.surveys.back().coefficients.empty());
        CHECK(adjustment.surveys.back().model == model);
        REQUIRE(adjustment.stations.size() == 10);
        double squares = 0.0, squares_alone = 0.0;
        for (const JointGravity& station : adjustment.stations) {
            const StationValue& alone =
                *std::ranges::find(day.result.stations, station.site, &StationValue::site);
            squares += std::pow(station.u.value(), 2);
            squares_alone += std::pow(alone.u_left_out->value(), 2);
            CHECK(std::abs(station.gravity.value() - gravity_of(station.site)) <
                  4.0 * station.u.value());
        }
        CHECK(squares < squares_alone);
    }
}

TEST_CASE("days of other models alone are adjusted together") {
    const Corrected a = corrected(1, "t-drift"), b = a_day_later(corrected(2, "network"));
    const auto adjustment =
        std::get<JointAdjustment>(adjust_jointly({{"a", "1", &a.result}, {"b", "2", &b.result}}));
    CHECK(adjustment.units.empty());
    CHECK(adjustment.differences.size() == 45);
    for (const JointGravity& station : adjustment.stations) {
        CHECK(std::abs(station.gravity.value() - gravity_of(station.site)) <
              4.0 * station.u.value());
    }
}

TEST_CASE("a day whose readings hardly determine its noise does not take part") {
    const Corrected day = corrected(1);
    Corrected few = a_day_later(corrected(2, "t-drift"));
    const auto reason_with = [&](std::size_t rows) {
        Corrected fewer = few;
        fewer.result.rows.resize(rows);
        const auto joint =
            adjust_jointly({{"a", "1", &day.result, &day.day}, {"b", "1", &fewer.result}});
        const auto* const reason = std::get_if<text::Message>(&joint);
        return reason == nullptr ? std::string() : reason->english();
    };
    // A constant, a slope and a drift: six readings leave three degrees of freedom.
    CHECK(reason_with(5) == "b has too few readings at known stations for the noise of t-drift");
    CHECK(reason_with(6).empty());

    // With few degrees of freedom the expected variance is larger than the estimated one.
    std::vector<SurveyRow> rows;
    for (const CorrectedRow& row : few.result.rows) rows.push_back(row.row);
    const auto joint = find_model("t-drift")->joint({rows, few.result.options, nullptr},
                                                    choose_rows(rows, {}, true));
    const auto dof = static_cast<double>(few.result.score.dof);
    CHECK(joint.value().survey.noise() * few.result.options.priors.reading_sd_mgal ==
          Approx(few.result.score.s_mgal.value() * std::sqrt(dof / (dof - 2.0))));

    // Readings that a line fits exactly keep the resolution of the tables.
    for (SurveyRow& row : rows)
        if (row.reference) row.acceleration = *row.reference + MilliGal(1800.0);
    std::erase_if(rows, [](const SurveyRow& row) { return row.is_flagged; });
    const auto exact = find_model("t-drift")->joint({rows, few.result.options, nullptr},
                                                    choose_rows(rows, {}, true));
    CHECK(exact.value().survey.noise() * few.result.options.priors.reading_sd_mgal ==
          Approx(adjustment::kLeastSd_mgal));
}

TEST_CASE("surveys that cannot be adjusted together are refused with the reason") {
    const Corrected a = corrected(1), paper = corrected(2, "paper"),
                    moved = corrected(2, "day", 3.0),
                    network = a_day_later(corrected(2, "network"));
    const auto reason = [&](const Corrected& other, const std::string& serial) {
        return std::get<text::Message>(adjust_jointly(
            {{"a", "1", &a.result, &a.day}, {"b", serial, &other.result, &other.day}}));
    };
    CHECK(reason(paper, "2") == "b is corrected by paper, which is no adjustment");
    CHECK(reason(moved, "2") ==
          "the surveys have different references of S4, or different uncertainties of it");
    CHECK(reason(network, "1") == "the prior of b would count again for each day of its unit");
    CHECK(reason(moved, "1") == "a and b are of one unit (1) at the same time");
}
