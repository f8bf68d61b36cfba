#include "corrector/result/result_files.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "corrector/model/calibration_use.hpp"
#include "corrector/result/columns.hpp"
#include "corrector/result/export_files.hpp"
#include "corrector/result/network_report.hpp"
#include "corrector/result/scale_report.hpp"
#include "corrector/result/side_by_side_report.hpp"
#include "protocol/text/json_text.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {
namespace {

using Json = nlohmann::ordered_json;

Json interval_json(const std::optional<model::Interval>& interval) {
    return interval ? Json{interval->low, interval->high} : Json(nullptr);
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
    Json rows = Json::array();
    for (const auto& row : matrix.rowwise())
        rows.push_back(std::vector<double>(row.begin(), row.end()));
    return rows;
}

/// Returns the meaning of a test's place: temperature or time, or a reading.
std::string place_of(const model::SurveyCorrection& result, const whole_day::FitTest& test) {
    if (test.misfit == whole_day::Misfit::curvature)
        return test.place == 0 ? "temperature" : "time";
    const reading::SurveyRow& row = result.rows[test.place].row;
    return reading::stay_name(row.site, row.occupation);
}

Json fit_tests_json(const model::SurveyCorrection& result) {
    const auto* const day = result.as<model::WholeDayPart>();
    if (day == nullptr) return nullptr;
    Json tests = Json::array();
    for (const whole_day::FitTest& test : day->fit_tests)
        tests.push_back(
            {{"misfit", whole_day::kMisfitNames.at(static_cast<std::size_t>(test.misfit))},
             {"p", test.p},
             {"is_found", test.is_misfit()},
             {"at", place_of(result, test)}});
    return {{"tests", tests}, {"uncertainty_factor", day->uncertainty_factor}};
}

Json unit_json(const model::SurveyCorrection& result) {
    const auto* const day = result.as<model::WholeDayPart>();
    if (day == nullptr) return nullptr;
    const whole_day::UnitPosterior& unit = day->unit;
    Json names = Json::array();
    for (const whole_day::UnitParameter& parameter : whole_day::unit_parameters())
        names.push_back(parameter.name);
    return {{"parameters", names},
            {"values", std::vector<double>(unit.values.begin(), unit.values.end())},
            {"covariance", matrix_json(unit.covariance)},
            {"noise",
             {{"placement_mgal", unit.noise.placement_mgal},
              {"flicker_mgal", unit.noise.flicker_mgal},
              {"white_mgal", unit.noise.white_mgal}}}};
}

Json priors_json(const model::SurveyCorrection& result) {
    Json json{{"reading_sd_mgal", result.options.priors.reading_sd_mgal}};
    for (const adjustment::Term* const term : adjustment::terms_with_prior())
        if (const adjustment::Prior* const prior = result.options.priors.find(term->name))
            json[std::string(term->name)] = {{"mean", prior->mean}, {"sd", prior->sd}};
    return json;
}

}  // namespace

Json coefficients_json(const std::vector<model::Coefficient>& coefficients) {
    Json list = Json::array();
    for (const model::Coefficient& c : coefficients)
        list.push_back({{"name", c.name},
                        {"value", c.value},
                        {"standard_error", text::or_null(c.standard_error)}});
    return list;
}

Json covariance_json(const std::optional<model::StationCovariance>& covariance) {
    if (!covariance) return nullptr;
    return {{"sites", covariance->sites}, {"mgal2", matrix_json(covariance->mgal2)}};
}

std::string occupations_csv(const model::SurveyCorrection& result) {
    const auto columns = occupation_columns(result);
    std::string csv = csv_header(columns);
    const std::string rest(columns.size() - 9, ',');
    in_order_of_time(
        result, [&](std::size_t i) { csv += csv_line(columns, result.rows[i]); },
        [&](const reading::LeftOut& stay) {
            csv += fmt::format("{},{},,{},{},0,{}{},repeat,{}\n", stay.site, stay.occupation,
                               to_rfc3339(stay.start, 3), to_rfc3339(stay.end, 3), flag_of(stay),
                               rest, stay.reason);
        });
    return csv;
}

std::string stations_csv(const model::SurveyCorrection& result) {
    return csv_table(station_columns(result.stations), result.stations);
}

std::string differences_csv(const model::SurveyCorrection& result) {
    return csv_table(difference_columns(), result.differences);
}

std::string models_csv(const model::SurveyCorrection& result) {
    return csv_table(score_columns(result), score_rows(result));
}

std::string result_json(const model::SurveyCorrection& result, const Json& settings,
                        const std::vector<text::InputFile>& inputs) {
    Json json;
    json["program"] = "a351-correct";
    json["version"] = A351_VERSION;
    json["settings"] = settings;
    json["inputs"] = inputs;
    json["model"] = result.model;
    json["base"] = result.options.base;
    if (result.as<model::WholeDayPart>() == nullptr) {
        json["reference_temperature_degc"] = adjustment::kReferenceTemperature.value();
        json["reference_time_h_after_first_row"] = adjustment::kReferenceTime_h;
    }
    json["priors"] = priors_json(result);
    json["coefficients"] = coefficients_json(result.coefficients);
    json["scales"] = scales_json(result.scales);
    json["side_by_side"] = side_by_side_json(result);
    json["in_sample"] = {
        {"n", result.score.row_count},
        {"rms_mgal", text::or_null(result.score.rms_mgal)},
        {"s_mgal", text::or_null(result.score.s_mgal)},
        {"rms_before_drift_mgal", text::or_null(result.score.rms_before_drift_mgal)}};
    json["cross_validated"] = {{"loo_mgal", text::or_null(result.score.loo_mgal)},
                               {"loso_mgal", text::or_null(result.score.loso_mgal)},
                               {"choice_loso_mgal", text::or_null(result.choice_loso_mgal)},
                               {"loo_interval_95_mgal", interval_json(result.loo_interval_mgal)},
                               {"bootstrap_draws", model::kBootstrapDraws},
                               {"bootstrap_seed", result.options.seed}};
    json["choice_limit_mgal"] = result.choice ? Json(result.choice->limit_mgal) : Json(nullptr);
    json["network"] = network_json(result);
    json["goodness_of_fit"] = fit_tests_json(result);
    json["unit"] = unit_json(result);
    json["calibration"] = model::calibration_json(result);
    json["findings"] = reading::findings_json(result.findings);
    json["remarks"] = text::in_english(result.remarks);
    json["models"] = json_array(score_columns(result), score_rows(result));
    json["stations"] = json_array(station_columns(result.stations), result.stations);
    json["station_covariance"] = covariance_json(result.covariance);
    json["occupations"] = json_array(occupation_columns(result), result.rows);
    json["left_out"] = Json::array();
    for (const reading::LeftOut& occupation : result.left_out) {
        json["left_out"].push_back({{"site", occupation.site},
                                    {"occupation", occupation.occupation},
                                    {"start_utc", to_rfc3339(occupation.start, 3)},
                                    {"end_utc", to_rfc3339(occupation.end, 3)},
                                    {"reason", occupation.reason}});
    }
    return text::json_text(json, 2) + '\n';
}

std::vector<text::NamedText> result_files(const model::SurveyCorrection& result,
                                          const Json& settings,
                                          const std::vector<text::InputFile>& inputs,
                                          const std::vector<text::Site>& sites) {
    std::vector<text::NamedText> files{{"occupations.csv", occupations_csv(result)},
                                       {"stations.csv", stations_csv(result)},
                                       {"differences.csv", differences_csv(result)},
                                       {"models.csv", models_csv(result)},
                                       {"result.json", result_json(result, settings, inputs)}};
    for (text::NamedText& file : export_files(result, sites)) files.push_back(std::move(file));
    return files;
}

}  // namespace a351::corrector::result
