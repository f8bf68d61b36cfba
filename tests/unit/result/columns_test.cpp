#include "corrector/result/columns.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::result;

namespace {

const std::string kHead =
    "site,occupation,time_utc,start_utc,end_utc,used,flags,acceleration_mgal,temperature_degc,"
    "rate_degc_per_h,tide_mgal,difference_mgal,temperature_correction_mgal,rate_correction_mgal,"
    "drift_correction_mgal,corrected_mgal,reference_mgal,residual_mgal,leverage,u_corrected_mgal,"
    "studentised_residual,corrected1_mgal,residual1_mgal,";
const std::string kOfRecords =
    "key,series_mean_mgal,series_minus_curve_mgal,standard_error_mgal,temperature_range_degc,"
    "temperature_is_monotone,temperature_is_half_wave,valid_samples,partial_samples,"
    "missing_samples,recorded_min,mean_x_g,rms_x_mgal,mean_y_g,rms_y_mgal,mean_z_g,rms_z_mgal,"
    "rectification_mgal,eemd_mgal,smoother_mgal,u_smoother_mgal,smoother_minus_eemd_mgal,";
const std::string kTail = "doubt_physical,grade,grade_reason\n";

SurveyCorrection one_row() {
    SurveyCorrection result;
    CorrectedRow& row = result.rows.emplace_back();
    row.row.site = "No.0";
    row.is_used = true;
    row.own = PaperRow{MilliGal(979859.533), std::nullopt};
    return result;
}

std::string header(const SurveyCorrection& result) {
    return csv_header(occupation_columns(result));
}

}  // namespace

TEST_CASE("the table of occupations has columns only for what is known") {
    SurveyCorrection result = one_row();
    CorrectedRow& row = result.rows.front();
    CHECK(header(result) == kHead + kTail);
    row.tilt_correction = MilliGal(1.0);
    CHECK(header(result) == kHead + "tilt_correction_mgal," + kTail);
    row.row.instrument = "B44";
    CHECK(header(result) == kHead + "instrument,loop,tilt_correction_mgal," + kTail);
    row.row.instrument.clear();
    row.scale_correction = MilliGal(0.0);
    CHECK(header(result) == kHead + "scale_correction_mgal,tilt_correction_mgal," + kTail);
    row.scale_correction.reset();
    row.row.record.emplace();
    CHECK(header(result) == kHead + kOfRecords + "tilt_correction_mgal," + kTail);
    row.own = WholeDayRow{};
    CHECK(header(result) == kHead + kOfRecords +
                                "averaged_s,fast_rate_degc_per_h,tilt_correction_mgal,"
                                "flicker_correction_mgal,left_out_mgal," +
                                kTail);
}

TEST_CASE(
    "a cell has six decimals in CSV and all digits in JSON, and is empty or null without a value") {
    CHECK(csv_text(cell(1.0 / 3.0)) == "0.333333");
    CHECK(json_value(cell(1.0 / 3.0)) == 1.0 / 3.0);
    CHECK(csv_text(Cell(true)) == "1");
    CHECK(json_value(Cell(false)) == false);
    CHECK(csv_text(cell(std::size_t{19})) == "19");
    CHECK(json_value(cell(std::size_t{19})) == 19);
    CHECK(csv_text(cell(std::optional<MilliGal>())).empty());
    CHECK(json_value(cell(std::optional<double>())).is_null());
    CHECK(csv_text(cell(UtcTime{})) == "1970-01-01T00:00:00.000Z");
}

TEST_CASE("values of one model are in its columns, which are empty for others") {
    SurveyCorrection result = one_row();
    result.rows.front().own = PaperRow{MilliGal(979859.533), MilliGal(0.677)};
    const auto of_paper = json_object(occupation_columns(result), result.rows.front());
    CHECK(of_paper["corrected1_mgal"] == 979859.533);
    CHECK(of_paper["residual1_mgal"] == 0.677);
    result.rows.front().own = {};
    const auto of_other = json_object(occupation_columns(result), result.rows.front());
    CHECK(of_other["corrected1_mgal"].is_null());
}

TEST_CASE("a table for people has headings, decimals, and only columns with a value") {
    struct Row {
        const char* name;
        double mgal;
        bool is_used;
    };
    const std::vector<Column<Row>> columns{
        {"name", [](const Row& row) { return std::string(row.name); }, {"Name", 0, 'n'}},
        {"mgal", [](const Row& row) { return cell(row.mgal); }, {"mGal", 2}},
        {"used", [](const Row& row) { return row.is_used; }, {"In fit", 0, 'l'}},
        {"hidden", [](const Row&) { return Cell(1.0); }},
        {"empty", [](const Row&) { return Cell(); }, {"Empty"}},
    };
    const Table table = table_of(columns, std::vector<Row>{{"A", 1.006, true}, {"B", 2.0, false}});
    CHECK(table.headings == std::vector<std::string>{"Name", "mGal", "In fit"});
    CHECK(table.alignment == "nrl");
    CHECK(table.rows[0] == std::vector<std::string>{"A", "1.01", "yes"});
    CHECK(table.rows[1] == std::vector<std::string>{"B", "2.00", "no"});
    CHECK(shown_text(Cell(), 3) == "-");
    CHECK(shown_text(cell(UtcTime{}), 0) == "1970-01-01T00:00:00Z");
    const auto chosen = with_keys(columns, {"used", "unknown", "name"});
    REQUIRE(chosen.size() == 2);
    CHECK(chosen.front().key == "used");
}
