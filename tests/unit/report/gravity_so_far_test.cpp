#include "corrector/report/gravity_so_far.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/support/catch.hpp"

namespace a351::corrector::report {
namespace {

TEST_CASE("a remark on two set-ups of a stay is said once, with the larger numbers") {
    GravitySoFar so_far;
    so_far.read.emplace();
    so_far.result.emplace();
    for (const double off_mgal : {11.5, 11.6, 11.4}) {
        model::CorrectedRow& row = so_far.result->rows.emplace_back();
        row.row.site = "No.6";
        row.row.key = "K";
        row.row.reference = MilliGal(979800.0);
        row.corrected = MilliGal(979800.0 + off_mgal);
        row.residual = MilliGal(off_mgal);
        row.u_corrected = MilliGal(3.0);
    }
    for (const char* const reason : {"no samples", "too short"}) {
        reading::LeftOut& left_out = so_far.result->left_out.emplace_back();
        left_out.site = "No.6";
        left_out.key = "K";
        left_out.reason = reason;
    }
    const auto stays = to_json(so_far).at("stays");
    REQUIRE(stays.size() == 1);
    std::string said;
    for (const auto& remark : stays.at(0).at("remarks"))
        said += remark.at("text").get<std::string>() + '|';
    CHECK(said ==
          "no samples|too short|11.6 mGal above its reference, 3.9 times the uncertainty expected if "
          "name and reference are right|");
}

TEST_CASE("u of a stay is that of the mean of its set-ups") {
    // A station with u = 1 and placement = 2 mGal: two set-ups in its first stay, three in its second.
    constexpr double kStation_mgal = 1.0, kPlacement_mgal = 2.0, kCount = 5.0;
    GravitySoFar so_far;
    so_far.read.emplace();
    so_far.result.emplace();
    for (const char* const key : {"A", "A", "B", "B", "B"}) {
        model::CorrectedRow& row = so_far.result->rows.emplace_back();
        row.row.site = "No.6";
        row.row.key = key;
        row.row.occupation = *key == 'A' ? 1 : 2;
        row.corrected = MilliGal(979800.0);
        row.u_corrected = MilliGal(
            std::hypot(kStation_mgal, kPlacement_mgal * std::sqrt(1.0 - 1.0 / kCount)));
    }
    model::StationValue& station = so_far.result->stations.emplace_back();
    station.site = "No.6";
    station.row_count = static_cast<std::size_t>(kCount);
    station.u_gravity = MilliGal(kStation_mgal);
    const auto u = [&](std::size_t stay) {
        return to_json(so_far).at("stays").at(stay).at("u_mgal").get<double>();
    };
    for (const auto& [stay, set_ups] : {std::pair<std::size_t, double>(0, 2.0), {1, 3.0}})
        CHECK(u(stay) ==
              Approx(std::hypot(kStation_mgal,
                                kPlacement_mgal * std::sqrt(1.0 / set_ups - 1.0 / kCount))));
    // A return to the base makes the station better, not the placement of the stay.
    so_far.read->running_key = "A";
    so_far.u_evening = MilliGal(0.5);
    CHECK(u(0) == Approx(std::hypot(0.5, kPlacement_mgal * std::sqrt(1.0 / 2.0 - 1.0 / kCount))));
    so_far.u_evening.reset();
    // A misfit of the day enlarges the u of its stations, and so that of each stay.
    const double before = u(0);
    model::WholeDayPart part;
    part.uncertainty_factor = 2.0;
    so_far.result->own = part;
    station.u_gravity = MilliGal(2.0 * kStation_mgal);
    CHECK(u(0) == Approx(2.0 * before));
    so_far.result->rows.erase(so_far.result->rows.begin(), so_far.result->rows.begin() + 2);
    station.row_count = 3;
    CHECK(u(0) == Approx(2.0 * kStation_mgal));
}

}  // namespace
}  // namespace a351::corrector::report
