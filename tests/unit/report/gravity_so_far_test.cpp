#include "corrector/report/gravity_so_far.hpp"

#include <nlohmann/json.hpp>

#include "tests/support/catch.hpp"

namespace a351::corrector::report {
namespace {

TEST_CASE("a remark on two set-ups of a stay is said once, with the larger numbers",
          "[report][so_far]") {
    GravitySoFar so_far;
    so_far.read.emplace();
    so_far.result.emplace();
    for (const double off_mgal : {11.5, 11.6, 11.4}) {
        model::CorrectedRow row;
        row.row.site = "No.6";
        row.row.key = "K";
        row.row.reference = MilliGal(979800.0);
        row.corrected = MilliGal(979800.0 + off_mgal);
        row.residual = MilliGal(off_mgal);
        row.u_corrected = MilliGal(3.0);
        so_far.result->rows.push_back(row);
    }
    for (const char* const reason : {"no samples", "too short"}) {
        reading::LeftOut left_out;
        left_out.site = "No.6";
        left_out.key = "K";
        left_out.reason = reason;
        so_far.result->left_out.push_back(left_out);
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

}  // namespace
}  // namespace a351::corrector::report
