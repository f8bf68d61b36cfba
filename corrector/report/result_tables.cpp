#include "corrector/report/result_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/judgement/closure.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/answer.hpp"
#include "corrector/result/columns.hpp"
#include "corrector/result/paper_report.hpp"
#include "corrector/result/side_by_side_report.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/json_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {
namespace {

using text::tr;

/// Returns date and time of the first instant, and time of the last.
std::string between(UtcTime start, UtcTime end) {
    const std::string text = to_rfc3339(start);
    return fmt::format("{} {}\u2013{}", text.substr(0, 10), text.substr(11, 8),
                       to_rfc3339(end).substr(11, 8));
}

/// Returns the instants between which a row was averaged.
std::string averaged(const reading::SurveyRow& row) {
    return row.start && row.end ? between(*row.start, *row.end) : "-";
}

/// Returns the columns of a result that follow the name of a reading and its times.
std::vector<result::Column<model::CorrectedRow>> reading_columns(
    const model::SurveyCorrection& result) {
    return result::with_decimals(
        result::with_keys(result::occupation_columns(result),
                          {"used_min", "recorded_min", "used", "corrected_mgal", "reference_mgal",
                           "residual_mgal", "left_out_mgal", "u_corrected_mgal",
                           "studentised_residual", "grade", "flags"}),
        result::decimals_of(result));
}

std::string reading_caption(const model::SurveyCorrection& result) {
    const std::string text =
        tr("Gravity of the readings in mGal, with all corrections. Residual = corrected - "
           "reference, in sample where the reading is in the fit. ");
    if (result.as<model::NetworkPart>() != nullptr)
        return text + tr("u: standard uncertainty of a single reading, a priori; t: studentised "
                         "residual.");
    if (result.as<model::WholeDayPart>() == nullptr)
        return text + tr("u: standard uncertainty of a new station, from the scatter in sample; t: "
                         "studentised residual.");
    return text +
           tr("The model day averages all undisturbed samples between the two instants; their "
              "duration is below Min used. The residual is the error of placing the box, one "
              "value for each set-up. Left out: the value of the reading if the reference of its "
              "station is not used (cross-validated); u is the standard uncertainty of this value, "
              "and t = (left out - reference) / sqrt(u^2 + (u of the reference)^2).");
}

std::string station_caption(const model::SurveyCorrection& result, const result::Table& table) {
    const auto has = [&table](std::string_view heading) {
        return std::ranges::find(table.headings, heading) != table.headings.end();
    };
    return tr("Residuals are in sample.") +
           (has("Left out mGal")
                ? tr(" Left out: value without the station's own reference (cross-validated).")
                : "") +
           (result.as<model::WholeDayPart>() != nullptr
                ? tr(" u is a standard uncertainty, as if the station were unknown.")
            : result.as<model::NetworkPart>() != nullptr
                ? tr(" u is a standard uncertainty, a priori.")
                : tr(" u is a standard uncertainty, from the scatter in sample.")) +
           (has("U 95 % mGal") ? tr(" Gravity of an unknown station is within ± U of the value "
                                    "with a probability of 95 %.")
                               : "") +
           (has("Flagged only") ? tr(" Flagged only: only readings that were left out of the fit.")
                                : "");
}

/// Returns the mean of the temperature corrections, rounded as they are shown.  It contains the
/// constant of the model with the bias of the sensor.
MilliGal constant_of(const model::SurveyCorrection& result, int decimals) {
    double sum_mgal = 0.0;
    for (const model::CorrectedRow& row : result.rows)
        sum_mgal += row.temperature_correction.value();
    const double steps = std::pow(10.0, decimals);
    return MilliGal(std::round(steps * sum_mgal / static_cast<double>(result.rows.size())) / steps);
}

}  // namespace

void add_stations(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const result::Table table = result::stations_table(result);
    add(parent, "h3", tr("Stations"));
    add_table(parent, station_caption(result, table), table);
}

void add_budget(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const result::Table table = result::budget_table(result);
    if (table.rows.empty()) return;
    add(parent, "h3", tr("Sources of the uncertainty"));
    add_table(
        parent,
        tr("Standard uncertainties in mGal; the sum of their squares is u squared. Placement "
           "becomes smaller with further set-ups. Levelling: unknown biases of the horizontal "
           "axes; smaller if the box is level, or with a tilt series. Thermal: the unit's "
           "response to temperature; smaller with a calibration or more known stations. Datum: "
           "the references. Scale: what is not known of the sensor's scale factor; it grows "
           "with the difference of gravity from the held stations."),
        table);
}

void add_readings(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const std::vector<result::Column<model::CorrectedRow>> columns = reading_columns(result);
    const bool is_recorded = result.rows.front().row.start.has_value();
    constexpr std::size_t kFirst = 2;  // columns before those of the declaration
    result::Table table = result::empty_table(columns);
    const HtmlCells leading = is_recorded
                                  ? HtmlCells{text::marked("Reading"), text::marked("Averaged UTC")}
                                  : HtmlCells{text::marked("Reading"), text::marked("Time UTC")};
    table.headings.insert(table.headings.begin(), leading.begin(), leading.end());
    table.alignment.insert(0, "nn");
    const auto add_row = [&](std::size_t i) {
        const model::CorrectedRow& row = result.rows[i];
        HtmlCells cells{judgement::reading_name(result.rows, i), to_rfc3339(row.row.time)};
        if (is_recorded) cells[1] = averaged(row.row);
        HtmlCells rest = result::shown_row(columns, row);
        for (auto at = rest.back().find(';'); at != std::string::npos;
             at = rest.back().find(';', at + 1))
            rest.back().insert(at + 1, " ");  // so that the line can break
        cells.insert(cells.end(), rest.begin(), rest.end());
        table.rows.push_back(std::move(cells));
    };
    result::in_order_of_time(result, add_row, [&](const reading::LeftOut& stay) {
        HtmlCells& cells = table.rows.emplace_back(kFirst + columns.size(), "-");
        cells.front() = reading::stay_name(stay.site, stay.occupation);
        cells[1] = is_recorded ? between(stay.start, stay.end) : to_rfc3339(stay.start);
        cells.back() = stay.reason;
    });
    add_table(parent, reading_caption(result), table);
}

void add_corrections(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const bool is_day = result.as<model::WholeDayPart>() != nullptr;
    const int decimals = result::decimals_of(result) + 1;
    const MilliGal constant = constant_of(result, decimals);
    std::vector<result::Column<model::CorrectedRow>> columns = result::with_decimals(
        result::with_keys(
            result::occupation_columns(result),
            {"acceleration_mgal", "temperature_degc",
             is_day ? "fast_rate_degc_per_h" : "rate_degc_per_h", "tide_mgal",
             "height_correction_mgal", "pressure_correction_mgal", "temperature_correction_mgal",
             "rate_correction_mgal", "drift_correction_mgal", "scale_correction_mgal",
             "tilt_correction_mgal", "flicker_correction_mgal", "corrected_mgal"}),
        decimals);
    for (result::Column<model::CorrectedRow>& column : columns)
        if (column.key == "temperature_correction_mgal")
            column.value = [constant](const model::CorrectedRow& row) {
                return result::cell(row.temperature_correction - constant);
            };
    result::Table table = result::table_of(columns, result.rows);
    table.headings.insert(table.headings.begin(), "Reading");
    table.alignment.insert(0, "n");
    for (std::size_t i = 0; i < table.rows.size(); ++i)
        table.rows[i].insert(table.rows[i].begin(), judgement::reading_name(result.rows, i));
    add(parent, "h3", tr("Corrections"));
    add_table(
        parent,
        tr("From acceleration to gravity, in mGal: corrected = acceleration - tide + constant "
           "+ the other columns. The constant of {} contains the bias of the sensor and the "
           "mean effect of its temperature; T corr. is the rest of this effect.",
           text::fixed(constant.value(), decimals)) +
            (is_day ? tr(" °C/h is the rate that the model's fast term uses.") : ""),
        table);
}

void add_paper_table(pugi::xml_node parent, const model::SurveyCorrection& result) {
    if (!result::is_paper(result)) return;
    add(parent, "h3", tr("Table 2 of the publication"));
    add_table(parent,
              tr("The steps of the publication, in mGal and °C. Difference: acceleration - tide - "
                 "reference; (1) after the line in temperature, (2) after the drift step too; "
                 "errors are reference - corrected.") +
                  ' ' + result::paper_errors(result),
              result::paper_table(result));
}

void add_side_by_side(pugi::xml_node parent, const model::SurveyCorrection& result) {
    for (const std::string& sentence : result::side_by_side_sentences(result))
        add(parent, "p", sentence);
    add_table(
        parent,
        tr("Gravity by the sensor and by the reference gravimeter. Ours: with the reference of the "
           "station hidden (cross-validated)."),
        result::table_of(result::side_by_side_columns(), result.side_by_side->stations));
}

void add_closures(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const std::vector<judgement::Closure> closures = judgement::close_stations(result);
    add(parent, "h3", tr("Repeated stations"));
    if (closures.empty()) {
        add(parent, "p",
            tr("No station was read twice, so there are no closures; drift is visible only against "
               "the references."));
        return;
    }
    using judgement::Closure;
    constexpr std::array kSteps{&Closure::before, &Closure::after_tide, &Closure::after_temperature,
                                &Closure::after_rate, &Closure::after_all};
    const auto number = [decimals = result::decimals_of(result)](MilliGal value) {
        return text::fixed(value.value(), decimals);
    };
    std::vector<HtmlCells> rows;
    for (const Closure& pair : closures) {
        HtmlCells& cells = rows.emplace_back(HtmlCells{
            judgement::reading_name(result.rows, pair.earlier),
            judgement::reading_name(result.rows, pair.later), text::fixed(pair.hours, 2)});
        for (const auto step : kSteps) cells.push_back(number(pair.*step));
        cells.push_back(text::fixed_or(pair.drift_mgal_per_h, 1, "-"));
    }
    HtmlCells& last = rows.emplace_back(HtmlCells{tr("RMS of {}", closures.size()), "", ""});
    for (const auto step : kSteps) last.push_back(number(judgement::rms_of(closures, step)));
    last.emplace_back();
    add_table(parent,
              tr("Later minus earlier reading of one station, in mGal. Drift: the drift that this "
                 "pair alone would mean, the difference after rate divided by the time between the "
                 "readings. The last differences are in sample, "
                 "because the coefficients were fitted to the same readings."),
              "nnrrrrrrr",
              {tr("Earlier"), tr("Later"), tr("Hours"), tr("As read"), tr("After tide"),
               tr("After temperature"), tr("After rate, tilt"), tr("After drift (all)"),
               tr("Drift mGal/h")},
              rows);
}

void add_models(pugi::xml_node parent, const model::SurveyCorrection& result) {
    add(parent, "h3", tr("Models"));
    add_table(
        parent,
        tr("Errors of all models. RMS and s: in sample. LOO: RMS error of a reading predicted "
           "without it (leave-one-out). LOSO: RMS error of the readings of a station predicted "
           "without them (leave-one-station-out)."),
        result::models_table(result));
    if (result.choice)
        add(parent, "p",
            tr("Chosen: among the models within one standard error of the least "
               "leave-one-station-out error, up to {} mGal, the one with the fewest "
               "terms.",
               text::fixed(result.choice->limit_mgal, 2)));
    if (result.choice_loso_mgal)
        add(parent, "p",
            tr("With the model chosen again for each station left out: {} mGal (cross-validated).",
               text::fixed(*result.choice_loso_mgal, 2)));
    std::vector<HtmlCells> coefficients;
    for (const model::Coefficient& c : result.coefficients) {
        const int decimals = result::decimals_of(c);
        coefficients.push_back({c.name, text::fixed(c.value, decimals),
                                text::fixed_or(c.standard_error, decimals, "-")});
    }
    add(parent, "h3", tr("Coefficients of {}", result.model));
    add_table(parent, tr("Standard errors are those of the fit (in sample)."), "lrr",
              {tr("Coefficient"), tr("Value"), tr("Standard error")}, coefficients);
}

void add_provenance(pugi::xml_node parent, const nlohmann::ordered_json& settings,
                    const std::vector<text::InputFile>& inputs, const std::string& title,
                    const std::vector<std::string>& warnings) {
    add(parent, "h3", title);
    if (warnings.empty()) add(parent, "p", tr("None."));
    add_list(parent, warnings);
    std::vector<HtmlCells> rows;
    for (const auto& [key, value] : settings.items()) {
        if (key == "warnings") continue;
        rows.push_back(
            {key, value.is_string() ? value.get<std::string>() : text::json_text(value)});
    }
    rows.push_back({"program", "a351-correct " A351_VERSION});
    add(parent, "h3", tr("Settings"));
    add_table(parent, tr("Options of the run."), "ll", {tr("Setting"), tr("Value")}, rows);
    std::vector<HtmlCells> files;
    for (const text::InputFile& input : inputs)
        files.push_back({input.role, input.name, std::to_string(input.byte_count),
                         fmt::format("{:08x}", input.crc32)});
    add(parent, "h3", tr("Inputs"));
    add_table(parent, tr("Files that were read."), "llrr",
              {tr("Role"), tr("File"), tr("Bytes"), "CRC-32"}, files);
}

}  // namespace a351::corrector::report
