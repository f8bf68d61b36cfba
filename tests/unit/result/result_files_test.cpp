#include "corrector/result/result_files.hpp"

#include <nlohmann/json.hpp>
#include <system_error>

#include "corrector/judgement/physical_doubt.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/text/write_together.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::result;

namespace {

SurveyCorrection corrected(const std::string& model) {
    auto rows = made_up::day();
    rows[3].is_flagged = true;
    rows[3].notes = {"fallback"};
    rows[4].reference.reset();
    rows[2].acceleration = rows[2].acceleration + MilliGal(1.0);
    SurveyCorrection result = correct_survey(rows, {.model = model});
    for (CorrectedRow& row : result.rows)
        row.doubt_physical = a351::corrector::judgement::physical_doubt(row.row);
    return result;
}

std::size_t file_count(const std::filesystem::path& folder) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file()) ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("numbers are written in fixed form, never as minus zero") {
    CHECK(text::fixed(979860.21, 3) == "979860.210");
    CHECK(text::fixed(-0.0001, 3) == "0.000");
    CHECK(text::fixed(-0.0006, 3) == "-0.001");
    CHECK(text::fixed(1e6, 0) == "1000000");
}

TEST_CASE("the tables have the documented columns and one line per item") {
    const SurveyCorrection result = corrected("t-rate");
    const auto occupations = text::CsvTable::parse(occupations_csv(result), "occupations.csv");
    CHECK(occupations_csv(result).starts_with(
        "site,occupation,time_utc,start_utc,end_utc,used,flags,acceleration_mgal,temperature_degc,"
        "rate_degc_per_h,tide_mgal,difference_mgal,temperature_correction_mgal,"
        "rate_correction_mgal,drift_correction_mgal,corrected_mgal,reference_mgal,residual_mgal,"
        "leverage,u_corrected_mgal,studentised_residual"));
    REQUIRE(occupations.row_count() == 12);
    CHECK(occupations.cell(3, "doubt_physical").find("fallback") != std::string::npos);
    CHECK(occupations.cell(3, "flags") == "outlier;fallback");
    CHECK(occupations.cell(3, "used") == "0");
    CHECK(occupations.cell(3, "grade") == "repeat");
    CHECK_THAT(occupations.cell(3, "grade_reason"),
               StartsWith("marked by the operator as not to be used; "));
    CHECK(occupations.cell(0, "grade") == "trust");
    CHECK(occupations.cell(4, "flags") == "no-reference");
    CHECK(occupations.cell(4, "residual_mgal").empty());
    CHECK(occupations.number(0, "residual_mgal") ==
          Approx(occupations.number(0, "corrected_mgal") - occupations.number(0, "reference_mgal"))
              .margin(2e-6));
    CHECK(stations_csv(result).starts_with(
        "site,n,gravity_mgal,u_gravity_mgal,reference_mgal,residual_mgal,redundancy"));
    const auto differences = text::CsvTable::parse(differences_csv(result), "differences.csv");
    REQUIRE(differences.row_count() == result.differences.size());
    REQUIRE(differences.row_count() > 0);
    const StationDifference& first = result.differences.front();
    CHECK(differences.cell(0, "from") == first.from);
    CHECK(differences.number(0, "difference_mgal") ==
          Approx(first.difference.value()).margin(1e-6));
    CHECK(differences.number(0, "residual_mgal") ==
          Approx((first.difference - *first.reference).value()).margin(1e-6));
    const auto json = nlohmann::json::parse(result_json(result, {}, {}));
    const auto& covariance = json.at("station_covariance");
    REQUIRE(covariance.at("sites").size() == covariance.at("mgal2").size());
    CHECK(covariance.at("mgal2")[0][1] == covariance.at("mgal2")[1][0]);
    CHECK(json.at("goodness_of_fit").is_null());
    const auto stations = text::CsvTable::parse(stations_csv(result), "stations.csv");
    CHECK(stations.number(0, "expanded_u_mgal") ==
          Approx(stations.number(0, "k_95") * stations.number(0, "u_gravity_mgal")).margin(1e-5));
    const auto models = text::CsvTable::parse(models_csv(result), "models.csv");
    CHECK(models_csv(result).starts_with(
        "model,rows,n,p,rms_mgal,s_mgal,loo_mgal,loso_mgal,aicc,selected"));
    REQUIRE(models.row_count() == 10);
    for (std::size_t row = 0; row < models.row_count(); ++row) {
        const bool is_it =
            models.cell(row, "model") == "t-rate" && models.cell(row, "rows") == "used";
        CHECK(models.cell(row, "selected") == (is_it ? "1" : "0"));
    }
}

TEST_CASE("an occupation without a value is listed with the grade repeat") {
    SurveyCorrection result = corrected("t-rate");
    const UtcTime start = result.rows[2].row.time - std::chrono::minutes(9);
    add_left_out(result, {{"S9", 2, start, start, "no samples"}});
    const auto occupations = text::CsvTable::parse(occupations_csv(result), "occupations.csv");
    REQUIRE(occupations.row_count() == 13);
    CHECK(occupations.cell(2, "site") == "S9");
    CHECK(occupations.cell(2, "flags") == "no-samples");
    CHECK(occupations.cell(2, "grade") == "repeat");
    CHECK(occupations.cell(2, "grade_reason") == "no samples");
}

TEST_CASE("the text says for every RMS whether it is in sample") {
    for (const std::string model : {"auto", "paper", "t"}) {
        const std::string text = survey_text(corrected(model), true);
        for (std::size_t at = text.find("RMS"); at != std::string::npos;
             at = text.find("RMS", at + 1)) {
            const std::string line = text.substr(at, text.find('\n', at) - at);
            CAPTURE(line);
            CHECK((line.find("in sample") != std::string::npos ||
                   line.find("leave-one") != std::string::npos));
        }
    }
}

TEST_CASE("the JSON holds settings, inputs, both RMS of the paper and every row") {
    const test::TemporaryDirectory folder;
    // CRC-32 of "123456789", the check value of the Rocksoft model.
    const text::InputFile input = text::describe_input("sites", folder.write("s.csv", "123456789"));
    CHECK(input.crc32 == 0xCBF43926);
    // A million times "a", by zlib's crc32(): more than one block.
    const text::InputFile large =
        text::describe_input("sites", folder.write("a", std::string(1'000'000, 'a')));
    CHECK(large.crc32 == 0xDC25BFBC);
    CHECK(large.byte_count == 1'000'000);
    const auto json = nlohmann::json::parse(
        result_json(corrected("paper"), {{"model", "paper"}, {"seed", 7}}, {input}));
    CHECK(json["settings"]["seed"] == 7);
    CHECK(json["inputs"][0]["byte_count"] == 9);
    CHECK(json["inputs"][0]["name"] == "s.csv");
    CHECK(json["in_sample"]["rms_mgal"].is_number());
    CHECK(json["in_sample"]["rms_before_drift_mgal"].is_number());
    CHECK(json["occupations"].size() == 12);
    CHECK(json["priors"]["reading_sd_mgal"] == 2.0);
    CHECK(json["network"].is_null());
    CHECK(json["occupations"][4]["residual_mgal"].is_null());
    CHECK(json["models"].size() == 10);
}

TEST_CASE("the same rows give result files with the same bytes") {
    const auto write = [] { return result_files(corrected("auto"), {{"model", "auto"}}, {}, {}); };
    CHECK(write() == write());
}

TEST_CASE("files are written together or not at all") {
    const test::TemporaryDirectory folder;
    const auto out = folder.path() / "a" / "b";
    text::write_together(out, {{"x.csv", "1"}, {"y.csv", "2"}});
    CHECK(text::read_text_file(out / "x.csv") == "1");
    CHECK(file_count(out) == 2);

    SECTION("a name may include a folder") {
        text::write_together(out, {{"x.csv", "3"}, {"figures/z.dat", "4"}});
        CHECK(text::read_text_file(out / "figures" / "z.dat") == "4");
        CHECK(text::read_text_file(out / "x.csv") == "3");
    }
    SECTION("a later run replaces both") {
        text::write_together(out, {{"x.csv", "3"}, {"y.csv", "4"}});
        CHECK(text::read_text_file(out / "y.csv") == "4");
        CHECK(file_count(out) == 2);
    }
    SECTION("a name that cannot be written leaves everything as it was") {
        std::filesystem::create_directory(out / "z.csv");
        CHECK_THROWS_AS(text::write_together(out, {{"x.csv", "3"}, {"z.csv", "4"}}),
                        std::system_error);
        CHECK(text::read_text_file(out / "x.csv") == "1");
        CHECK(file_count(out) == 2);
    }
}
