#include "corrector/result/result_files.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "corrector/model/calibration_use.hpp"
#include "corrector/result/network_report.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> number(const std::optional<MilliGal>& value) {
    if (!value) return std::nullopt;
    return value->value();
}

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json json_of(const std::optional<MilliGal>& value) { return json_of(number(value)); }

Json json_of(const std::optional<UtcTime>& time) {
    return time ? Json(to_rfc3339(*time, 3)) : Json(nullptr);
}

/// One line of a CSV table, cell by cell.
class CsvLine {
public:
    CsvLine& text(std::string_view cell) {
        if (!line_.empty() || !is_first_) line_ += ',';
        is_first_ = false;
        line_ += cell;
        return *this;
    }
    CsvLine& number(const std::optional<double>& value, int decimals = 6) {
        return text(text::fixed_or(value, decimals, ""));
    }
    CsvLine& number(const std::optional<MilliGal>& value) {
        return number(corrector::number(value));
    }
    CsvLine& number(MilliGal value) { return number(value.value()); }
    CsvLine& time(const std::optional<UtcTime>& value) {
        return text(value ? to_rfc3339(*value, 3) : "");
    }
    CsvLine& count(std::size_t value) { return text(std::to_string(value)); }

    [[nodiscard]] std::string end() const { return line_ + '\n'; }

private:
    std::string line_;
    bool is_first_ = true;
};

Json score_json(const SurveyCorrection& result, const ScoredRowSet& set, const ModelScore& score) {
    Json json;
    json["model"] = score.model;
    json["rows"] = set.rows;
    json["n"] = score.row_count;
    json["p"] = score.parameter_count;
    json["dof"] = score.dof;
    json["rms_mgal"] = json_of(score.rms_mgal);
    json["s_mgal"] = json_of(score.s_mgal);
    json["loo_mgal"] = json_of(score.loo_mgal);
    json["loso_mgal"] = json_of(score.loso_mgal);
    json["aicc"] = json_of(score.aicc);
    json["rms_before_drift_mgal"] = json_of(score.rms_before_drift_mgal);
    json["selected"] = is_selected(result, set, score);
    json["calibration"] = calibration_in(result, score);
    return json;
}

Json row_json(const CorrectedRow& row, const SurveyOptions& options) {
    Json json;
    json["site"] = row.row.site;
    json["occupation"] = row.row.occupation;
    json["time_utc"] = to_rfc3339(row.row.time, 3);
    json["start_utc"] = json_of(row.row.start);
    json["end_utc"] = json_of(row.row.end);
    json["used"] = row.is_used;
    json["flags"] = flags_of(row, options);
    json["acceleration_mgal"] = row.row.acceleration.value();
    json["temperature_degc"] = row.row.temperature.value();
    json["rate_degc_per_h"] = row.row.rate_degc_per_h;
    json["tide_mgal"] = row.row.tide.value();
    json["difference_mgal"] = json_of(row.difference);
    json["temperature_correction_mgal"] = row.temperature_correction.value();
    json["rate_correction_mgal"] = row.rate_correction.value();
    json["drift_correction_mgal"] = row.drift_correction.value();
    json["corrected_mgal"] = row.corrected.value();
    json["reference_mgal"] = json_of(row.row.reference);
    json["residual_mgal"] = json_of(row.residual);
    json["leverage"] = json_of(row.leverage);
    json["u_corrected_mgal"] = json_of(row.u_corrected);
    json["studentised_residual"] = json_of(row.studentised_residual);
    json["corrected1_mgal"] = json_of(row.corrected1);
    for (const SurveyRow::Detail& detail : row.row.details)
        json[detail.name] = json_of(detail.value);
    json["weight"] = json_of(row.weight);
    json["doubt_physical"] = row.doubt_physical;
    json["doubt_statistical"] = row.doubt_statistical;
    return json;
}

Json interval_json(const std::optional<Interval>& interval) {
    return interval ? Json{interval->low, interval->high} : Json(nullptr);
}

Json priors_json(const SurveyCorrection& result) {
    Json json{{"reading_sd_mgal", result.options.priors.reading_sd_mgal}};
    for (const std::string_view name : kPriorNames) {
        if (const Prior* const prior = result.options.priors.find(name)) {
            json[std::string(name)] = {{"mean", prior->mean}, {"sd", prior->sd}};
        }
    }
    return json;
}

Json station_json(const StationValue& station) {
    Json json;
    json["site"] = station.site;
    json["n"] = station.row_count;
    json["gravity_mgal"] = station.gravity.value();
    json["u_gravity_mgal"] = json_of(station.u_gravity);
    json["reference_mgal"] = json_of(station.reference);
    json["residual_mgal"] = json_of(station.residual);
    json["redundancy"] = json_of(station.redundancy);
    json["flagged_only"] = station.is_flagged_only;
    json["u_a_posteriori_mgal"] = json_of(station.u_a_posteriori);
    return json;
}

}  // namespace

std::string occupations_csv(const SurveyCorrection& result) {
    std::string csv =
        "site,occupation,time_utc,start_utc,end_utc,used,flags,acceleration_mgal,temperature_degc,"
        "rate_degc_per_h,tide_mgal,difference_mgal,temperature_correction_mgal,"
        "rate_correction_mgal,drift_correction_mgal,corrected_mgal,reference_mgal,residual_mgal,"
        "leverage,u_corrected_mgal,studentised_residual,corrected1_mgal";
    for (const SurveyRow::Detail& detail : result.rows.front().row.details) {
        csv += ',' + detail.name;
    }
    csv += ",weight,doubt_physical,doubt_statistical";
    const auto column_count = std::count(csv.begin(), csv.end(), ',') + 1;
    csv += '\n';
    auto left_out = result.left_out.begin();
    const auto add_left_out_before = [&](UtcTime time) {
        for (; left_out != result.left_out.end() && left_out->start < time; ++left_out) {
            CsvLine line;
            line.text(left_out->site).text(std::to_string(left_out->occupation)).text("");
            line.time(left_out->start).time(left_out->end).text("0").text(flag_of(*left_out));
            for (auto column = column_count - 7; column > 0; --column) line.text("");
            csv += line.end();
        }
    };
    for (const CorrectedRow& row : result.rows) {
        add_left_out_before(row.row.time);
        CsvLine line;
        line.text(row.row.site).text(std::to_string(row.row.occupation)).time(row.row.time);
        line.time(row.row.start).time(row.row.end).text(row.is_used ? "1" : "0");
        line.text(flags_of(row, result.options));
        line.number(row.row.acceleration).number(row.row.temperature.value());
        line.number(row.row.rate_degc_per_h).number(row.row.tide).number(row.difference);
        line.number(row.temperature_correction).number(row.rate_correction);
        line.number(row.drift_correction).number(row.corrected).number(row.row.reference);
        line.number(row.residual).number(row.leverage).number(row.u_corrected);
        line.number(row.studentised_residual).number(row.corrected1);
        for (const SurveyRow::Detail& detail : row.row.details) line.number(detail.value);
        line.number(row.weight).text(row.doubt_physical).text(row.doubt_statistical);
        csv += line.end();
    }
    add_left_out_before(UtcTime::max());
    return csv;
}

std::string stations_csv(const SurveyCorrection& result) {
    std::string csv =
        "site,n,gravity_mgal,u_gravity_mgal,reference_mgal,residual_mgal,redundancy,"
        "flagged_only,u_a_posteriori_mgal\n";
    for (const StationValue& station : result.stations) {
        CsvLine line;
        line.text(station.site).count(station.row_count).number(station.gravity);
        line.number(station.u_gravity).number(station.reference).number(station.residual);
        line.number(station.redundancy).text(station.is_flagged_only ? "1" : "0");
        line.number(station.u_a_posteriori);
        csv += line.end();
    }
    return csv;
}

std::string models_csv(const SurveyCorrection& result) {
    std::string csv =
        "model,rows,n,p,rms_mgal,s_mgal,loo_mgal,loso_mgal,aicc,selected,rms_before_drift_mgal,"
        "dof,calibration\n";
    for (const ScoredRowSet& set : result.row_sets) {
        for (const ModelScore& score : set.scores) {
            CsvLine line;
            line.text(score.model).text(set.rows).count(score.row_count);
            line.count(score.parameter_count).number(score.rms_mgal).number(score.s_mgal);
            line.number(score.loo_mgal).number(score.loso_mgal).number(score.aicc);
            line.text(is_selected(result, set, score) ? "1" : "0");
            line.number(score.rms_before_drift_mgal).count(score.dof);
            line.text(calibration_in(result, score));
            csv += line.end();
        }
    }
    return csv;
}

std::string result_json(const SurveyCorrection& result, const Json& settings,
                        const std::vector<text::InputFile>& inputs) {
    Json json;
    json["program"] = "a351-correct";
    json["version"] = A351_VERSION;
    json["settings"] = settings;
    json["inputs"] = Json::array();
    for (const text::InputFile& input : inputs) {
        json["inputs"].push_back({{"role", input.role},
                                  {"name", input.name},
                                  {"byte_count", input.byte_count},
                                  {"crc32", input.crc32}});
    }
    json["model"] = result.model;
    json["base"] = result.options.base;
    if (result.model != "day") {
        json["reference_temperature_degc"] = kReferenceTemperature.value();
        json["reference_time_h_after_first_row"] = kReferenceTime_h;
    }
    json["priors"] = priors_json(result);
    if (result.model == "robust") json["robust_terms"] = result.options.robust_terms;
    json["coefficients"] = Json::array();
    for (const Coefficient& c : result.coefficients) {
        json["coefficients"].push_back(
            {{"name", c.name}, {"value", c.value}, {"standard_error", json_of(c.standard_error)}});
    }
    json["in_sample"] = {{"n", result.score.row_count},
                         {"rms_mgal", json_of(result.score.rms_mgal)},
                         {"s_mgal", json_of(result.score.s_mgal)},
                         {"rms_before_drift_mgal", json_of(result.score.rms_before_drift_mgal)}};
    json["cross_validated"] = {{"loo_mgal", json_of(result.score.loo_mgal)},
                               {"loso_mgal", json_of(result.score.loso_mgal)},
                               {"choice_loso_mgal", json_of(result.choice_loso_mgal)},
                               {"loo_interval_95_mgal", interval_json(result.loo_interval_mgal)},
                               {"bootstrap_draws", kBootstrapDraws},
                               {"bootstrap_seed", result.options.seed}};
    json["choice_limit_mgal"] = result.choice ? Json(result.choice->limit_mgal) : Json(nullptr);
    json["network"] = network_json(result);
    json["calibration"] = calibration_json(result);
    json["remarks"] = result.remarks;
    json["models"] = Json::array();
    for (const ScoredRowSet& set : result.row_sets) {
        for (const ModelScore& score : set.scores) {
            json["models"].push_back(score_json(result, set, score));
        }
    }
    json["stations"] = Json::array();
    for (const StationValue& station : result.stations) {
        json["stations"].push_back(station_json(station));
    }
    json["occupations"] = Json::array();
    for (const CorrectedRow& row : result.rows) {
        json["occupations"].push_back(row_json(row, result.options));
    }
    json["left_out"] = Json::array();
    for (const LeftOut& occupation : result.left_out) {
        json["left_out"].push_back({{"site", occupation.site},
                                    {"occupation", occupation.occupation},
                                    {"start_utc", to_rfc3339(occupation.start, 3)},
                                    {"end_utc", to_rfc3339(occupation.end, 3)},
                                    {"reason", occupation.reason}});
    }
    // A name of a site may be in any encoding; JSON is UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<text::NamedText> result_files(const SurveyCorrection& result, const Json& settings,
                                          const std::vector<text::InputFile>& inputs) {
    return {{"occupations.csv", occupations_csv(result)},
            {"stations.csv", stations_csv(result)},
            {"models.csv", models_csv(result)},
            {"result.json", result_json(result, settings, inputs)}};
}

}  // namespace a351::corrector
