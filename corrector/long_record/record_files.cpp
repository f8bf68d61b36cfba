#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/long_record/applied_tables.hpp"
#include "corrector/long_record/record_result.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::long_record {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(double value, int decimals) {
    return std::isfinite(value) ? text::fixed(value, decimals) : std::string();
}

/// Returns the shortest text that is read back as the same number; empty if it is not finite.
std::string exact_cell(double value) {
    return std::isfinite(value) ? text::shortest(value) : std::string();
}

// Json writes numbers that are not finite as null.
Json limits_json(const Limits& limits) {
    return {{"value", limits.value}, {"low", limits.low}, {"high", limits.high}};
}

Json points_json(const std::vector<ResponsePoint>& points) {
    Json list = Json::array();
    for (const ResponsePoint& point : points) {
        const bool is_claimed = point.refusal.empty();
        list.push_back(
            {{"period_s", point.period_s},
             {"shortest_s", point.shortest_s},
             {"longest_s", point.longest_s},
             {"gain_mgal_per_degc", is_claimed ? limits_json(point.gain) : Json(nullptr)},
             {"phase_deg", is_claimed ? limits_json(point.phase_deg) : Json(nullptr)},
             {"coherence", point.coherence},
             {"temperature_rms_degc", point.temperature_rms_degc},
             {"refused", is_claimed ? Json(nullptr) : Json(point.refusal.english())},
             {"needed", is_claimed ? Json(nullptr) : Json(point.needed.english())}});
    }
    return list;
}

Json mode_json(const std::optional<ChosenMode>& mode) {
    if (!mode) return nullptr;
    return {{"number", mode->number},
            {"period_s", mode->period_s},
            {"energy_share", mode->energy_share},
            {"neighbour_share", mode->neighbour_share}};
}

Json components_json(const eemd::Result& result, double step_s) {
    Json list = Json::array();
    const auto add = [&](const std::string& name, const eemd::Component& component) {
        list.push_back({{"component", name},
                        {"period_s", component.mean_period_samples * step_s},
                        {"energy_share", component.energy_share},
                        {"standard_error", text::or_null(component.standard_error)}});
    };
    for (std::size_t k = 0; k < result.modes.size(); ++k)
        add(fmt::format("imf{}", k + 1), result.modes[k]);
    add("residue", result.residue);
    return list;
}

Json two_paths_json(const TwoPathFit& fit) {
    Json json;
    const auto add = [&json](const char* list, const FittedParameter& parameter) {
        json[list][parameter.key] = {
            {"value", parameter.value},
            {"standard_error", parameter.standard_error},
            {"determined", parameter.is_determined},
            {"needed", parameter.is_determined ? Json(nullptr) : Json(parameter.needed.english())}};
    };
    for (std::size_t k = 0; k < fit.parameters.size(); ++k)
        add(k < kTwoPathTerms ? "parameters" : "outer_oven", fit.parameters[k]);
    // Covariance of the coefficients in their units, and of the logarithms of lags and times.
    for (Eigen::Index row = 0; row < fit.covariance.rows(); ++row) {
        Json cells = Json::array();
        for (Eigen::Index column = 0; column < fit.covariance.cols(); ++column)
            cells.push_back(fit.covariance(row, column));
        json["covariance"].push_back(std::move(cells));
    }
    json["static_slope_mgal_per_degc"] = fit.static_slope;
    json["static_slope_error_mgal_per_degc"] = fit.static_slope_error;
    json["static_slope_determined"] = fit.is_static_slope_determined;
    json["residual_rms_mgal"] = fit.residual_rms_mgal;
    json["residual_follows_temperature"] = points_json(fit.unexplained);
    return json;
}

Json segments_json(const RecordResult& result) {
    Json list = Json::array();
    for (std::size_t k = 0; k < result.parts.segments.size(); ++k) {
        const RecordSegment& segment = result.parts.segments[k];
        list.push_back({{"start_utc", to_rfc3339(segment.start, 3)},
                        {"end_utc", to_rfc3339(segment.end, 3)},
                        {"serial_number", text::or_null(segment.serial_number)},
                        {"samples", segment.size()},
                        {"begins_with", segment.begins_with.english()},
                        {"restart", segment.is_restart},
                        {"bridged", segment.bridged},
                        {"knocks", segment.disturbed},
                        {"analysed", result.tilt || k == result.analysed}});
    }
    return list;
}

Json tilt_json(const TiltFit& tilt) {
    return {{"axis", tilt.axis == 0 ? "x" : "y"},
            {"slope_urad_per_degc", tilt.slope_urad_per_degc},
            {"slope_error_urad_per_degc", tilt.slope_error_urad_per_degc},
            {"temperature_degc", tilt.temperature_degc},
            {"misfit", tilt.misfit},
            {"scatter_urad", tilt.noise.points.front().deviation_mgal.value}};
}

void add_limits(Json& json, const std::string& name, const Limits& limits) {
    // An infinite limit is written as null.
    json[name] = limits.value;
    json[name + "_low"] = limits.low;
    json[name + "_high"] = limits.high;
}

Json noise_json(const noise::RecordNoise& noise) {
    Json json;
    json["describe_record"] = noise.allan.noises.describes_record;
    add_limits(json, "white_mgal_sqrt_s", noise.allan.noises.white_mgal_sqrt_s);
    add_limits(json, "flicker_mgal", noise.allan.noises.flicker_mgal);
    add_limits(json, "walk_mgal_per_sqrt_s", noise.allan.noises.walk_mgal_per_sqrt_s);
    json["useful_average_s"] = noise.useful ? Json(noise.useful->averaging_s) : nullptr;
    json["stays"] = Json::array();
    for (const noise::StayScatter& stay : noise.stays)
        json["stays"].push_back(
            {{"averaging_s", stay.averaging_s}, {"scatter_mgal", stay.scatter_mgal}});
    json["allan"] = Json::array();
    for (const noise::AllanPoint& point : noise.allan.points) {
        Json one{{"averaging_s", point.averaging_s}};
        add_limits(one, "deviation_mgal", point.deviation_mgal);
        one["model_mgal"] = point.model_mgal;
        json["allan"].push_back(one);
    }
    return json;
}

/// Returns spectrum.csv: the spectral density of the acceleration, with 95 % limits.
std::string spectrum_csv(const noise::RecordNoise& noise) {
    std::string text = "frequency_hz,mgal_per_sqrt_hz,mgal_per_sqrt_hz_low,mgal_per_sqrt_hz_high\n";
    for (const noise::Density& one : noise.spectrum)
        text += fmt::format("{:.15g},{:.15g},{:.15g},{:.15g}\n", one.frequency_hz,
                            std::sqrt(one.mgal2_per_hz.value), std::sqrt(one.mgal2_per_hz.low),
                            std::sqrt(one.mgal2_per_hz.high));
    return text;
}

/// Returns record.csv: `time_utc,acceleration_mgal,temperature_degc,segment`, one row per sample.
/// Cells of missing values are empty.  Segments are numbered from 1; empty outside all.  With a
/// calibration `parametric_mgal` and `by_modes_mgal` follow, filled within the analysed segment, with
/// an outer oven `outer_degc`.  Of a tilt: `tilt_urad` in place of the acceleration, `corrected_urad`,
/// `u_urad`.
std::string record_csv(const RecordResult& result) {
    const bool has_outer = std::ranges::any_of(
        result.record.stretches,
        [](const RecordStretch& stretch) { return !stretch.outer_degc.empty(); });
    std::string csv = std::string("time_utc,") + (result.tilt ? "tilt_urad" : "acceleration_mgal") +
                      ",temperature_degc,segment" + (result.tilt ? ",corrected_urad,u_urad" : "") +
                      std::string(result.applied ? ",parametric_mgal,by_modes_mgal" : "") +
                      std::string(has_outer ? ",outer_degc\n" : "\n");
    for (const RecordStretch& stretch : result.record.stretches) {
        for (std::size_t i = 0; i < stretch.size(); ++i) {
            csv += to_rfc3339(stretch.times[i], 6) + ',' + exact_cell(stretch.quantity[i]) + ',' +
                   exact_cell(stretch.temperature_degc[i]) + ',';
            for (std::size_t k = 0; k < result.parts.segments.size(); ++k) {
                const RecordSegment& segment = result.parts.segments[k];
                if (stretch.times[i] >= segment.start && stretch.times[i] <= segment.end)
                    csv += std::to_string(k + 1);
            }
            csv += applied_cells(result, stretch.times[i]);
            if (result.tilt) {
                const double degc = stretch.temperature_degc[i],
                             corrected = result.tilt->corrected_urad(stretch.quantity[i], degc);
                csv += ',' + cell(corrected, 3) + ',' +
                       (std::isfinite(corrected) ? cell(result.tilt->u_urad(degc), 3) : "");
            }
            if (has_outer)
                csv += ',' + (stretch.outer_degc.empty() ? "" : exact_cell(stretch.outer_degc[i]));
            csv += '\n';
        }
    }
    return csv;
}

/// Returns response.csv: the response by period, by spectrum and by modes.
std::string response_csv(const RecordResult& result) {
    std::string csv =
        "way,period_s,shortest_s,longest_s,gain_mgal_per_degc,gain_low,gain_high,phase_deg,"
        "phase_low,phase_high,coherence,temperature_rms_degc,refused\n";
    const auto add = [&csv](const std::string& way, const std::vector<ResponsePoint>& points) {
        for (const ResponsePoint& point : points) {
            csv += way + ',' + cell(point.period_s, 1) + ',' + cell(point.shortest_s, 1) + ',' +
                   cell(point.longest_s, 1) + ',';
            if (point.refusal.empty()) {
                for (const Limits* limits : {&point.gain, &point.phase_deg})
                    for (const double value : {limits->value, limits->low, limits->high})
                        csv += cell(value, 3) + ',';
            } else {
                csv += ",,,,,,";
            }
            csv += cell(point.coherence, 4) + ',' + cell(point.temperature_rms_degc, 6) + ',' +
                   (point.refusal.empty() ? "0\n" : "1\n");
        }
    };
    add("spectrum", result.analysis.by_spectrum);
    add("modes", result.analysis.by_modes);
    return csv;
}

/// Returns result.json.
std::string record_json(const RecordResult& result, const Json& settings) {
    const RecordAnalysis& analysis = result.analysis;
    Json json;
    json["program"] = "a351-correct";
    json["version"] = A351_VERSION;
    json["settings"] = settings;
    json["inputs"] = result.record.inputs;
    json["serial_number"] = text::or_null(result.segment().serial_number);
    json["raw_rate_hz"] = result.record.raw_rate_hz;
    json["step_s"] = result.record.step_s;
    json["tide_removed"] = result.record.is_tide_removed;
    json["warnings"] = text::in_english(result.record.warnings);
    json["segments"] = segments_json(result);
    json["refused"] = Json::array();
    for (const RefusedPart& part : result.parts.refused)
        json["refused"].push_back({{"start_utc", to_rfc3339(part.start, 3)},
                                   {"end_utc", to_rfc3339(part.end, 3)},
                                   {"reason", part.reason.english()}});
    if (result.tilt) {
        json["tilt"] = tilt_json(*result.tilt);
        return json.dump(2) + '\n';
    }
    for (const RecordStatistic& statistic : record_statistics(result))
        json["statistics"][statistic.key] = statistic.value;
    json["temperature_mode"] = mode_json(analysis.temperature_mode);
    json["acceleration_mode"] = mode_json(analysis.acceleration_mode);
    json["temperature_components"] = components_json(analysis.temperature, analysis.step_s);
    json["acceleration_components"] = components_json(analysis.acceleration, analysis.step_s);
    json["causal_reading"] = analysis.reading.english();
    json["response_by_spectrum"] = points_json(analysis.by_spectrum);
    json["response_by_modes"] = points_json(analysis.by_modes);
    json["two_paths"] = two_paths_json(analysis.two_paths);
    json["noise"] = noise_json(analysis.noise);
    if (const auto level = result.record.data_sheet_mgal_per_sqrt_hz)
        json["noise"]["data_sheet_mgal_per_sqrt_hz"] = *level;
    json["applied"] = applied_json(result);
    json["remarks"] = text::in_english(analysis.remarks);
    return json.dump(2) + '\n';
}

}  // namespace

std::vector<text::NamedText> record_files(const RecordResult& result, const Json& settings) {
    if (result.tilt)
        return {{"record.csv", record_csv(result)}, {"result.json", record_json(result, settings)}};
    return {{"record.csv", record_csv(result)},
            {"response.csv", response_csv(result)},
            {"spectrum.csv", spectrum_csv(result.analysis.noise)},
            {"result.json", record_json(result, settings)}};
}

}  // namespace a351::corrector::long_record
