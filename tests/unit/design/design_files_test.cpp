#include "corrector/design/design_files.hpp"

#include <nlohmann/json.hpp>

#include "protocol/text/csv.hpp"
#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector::design;

TEST_CASE("files, text and JSON of a design agree") {
    const Design design = make_design(made_up_plan(), made_up_sites(), usual_unit());
    const auto files = design_files(design, {{"plan", "plan.csv", 10, 1}});
    REQUIRE(files.size() == 3);
    CHECK(files[0].first == "design.csv");
    const auto stations = text::CsvTable::parse(files[0].second, "design.csv");
    const auto differences = text::CsvTable::parse(files[1].second, "differences.csv");
    const auto json = nlohmann::json::parse(files[2].second);
    REQUIRE(stations.row_count() == 4);
    REQUIRE(differences.row_count() == 6);
    CHECK(stations.cell(0, "is_known") == "1");
    CHECK(stations.number(0, "set_ups") == 2.0);
    CHECK(stations.number(1, "u_mgal") == Approx(json["stations"][1]["u_mgal"].get<double>()));
    CHECK(differences.cell(5, "from") == "C");
    CHECK(differences.number(5, "u_difference_mgal") ==
          Approx(json["differences"][5]["u_difference_mgal"].get<double>()));
    CHECK(json["u_mgal"].get<double>() == design.errors.u_unknown.value());
    CHECK(json["hours"].get<double>() == Approx(2.2));
    CHECK(json["inputs"][0]["role"] == "plan");
    REQUIRE(json["alternatives"].size() == design.alternatives.size());
    const auto& best = json["alternatives"][0];
    CHECK(best["plan_change"] == plan_csv(design.alternatives[0].plan));
    CHECK(best["text"] == design.alternatives[0].text);
    const std::string text = design_text(design);
    CHECK_THAT(text, ContainsSubstring("5 visits of 4 stations (1 known), 5 set-ups, 2.2 h") &&
                         ContainsSubstring(design.alternatives[0].text));
}
