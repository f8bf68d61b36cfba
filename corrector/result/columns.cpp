#include "corrector/result/columns.hpp"

#include <algorithm>
#include <map>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/model/calibration_use.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/catalogue.hpp"

namespace a351::corrector::result {
namespace {

using Columns = std::vector<Column<model::CorrectedRow>>;

void append(Columns& columns, Columns more) {
    columns.insert(columns.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
}

Column<model::CorrectedRow> of_record(std::string_view key,
                                      Cell (*value)(const reading::RecordSummary&)) {
    return {key, [value](const model::CorrectedRow& row) { return value(row.row.record.value()); }};
}

Column<model::CorrectedRow> of_shape(std::string_view key, reading::TemperatureShape shape) {
    return {key, [shape](const model::CorrectedRow& row) {
                return row.row.record.value().temperature_shape == shape ? 1.0 : 0.0;
            }};
}

/// Returns a column of what only one model gives; its cells are empty for other models.
template <class Part, class Value>
Column<model::CorrectedRow> of_model(std::string_view key, Value Part::*member, Shown shown = {}) {
    const auto cell_of = [member](const model::CorrectedRow& row) {
        const auto* const own = row.as<Part>();
        return own != nullptr ? cell(own->*member) : Cell();
    };
    return {key, cell_of, shown};
}

Columns columns_of_records() {
    using R = const reading::RecordSummary&;
    return {
        {"key", [](const model::CorrectedRow& row) { return row.row.key; }},
        of_record("series_mean_mgal", [](R r) { return cell(r.series_mean); }),
        of_record("series_minus_curve_mgal",
                  [](R r) { return cell(r.series_mean - r.curve_mean); }),
        of_record("standard_error_mgal", [](R r) { return cell(r.standard_error); }),
        of_record("temperature_range_degc", [](R r) { return cell(r.temperature_range.value()); }),
        of_shape("temperature_is_monotone", reading::TemperatureShape::monotone),
        of_shape("temperature_is_half_wave", reading::TemperatureShape::half_wave),
        of_record("valid_samples", [](R r) { return cell(static_cast<double>(r.counts.valid)); }),
        of_record("partial_samples",
                  [](R r) { return cell(static_cast<double>(r.counts.partial)); }),
        of_record("missing_samples",
                  [](R r) { return cell(static_cast<double>(r.counts.missing)); }),
        of_record("mean_x_g", [](R r) { return cell(r.x.mean.value()); }),
        of_record("rms_x_mgal", [](R r) { return cell(r.x.rms); }),
        of_record("mean_y_g", [](R r) { return cell(r.y.mean.value()); }),
        of_record("rms_y_mgal", [](R r) { return cell(r.y.rms); }),
        of_record("mean_z_g", [](R r) { return cell(r.z.mean.value()); }),
        of_record("rms_z_mgal", [](R r) { return cell(r.z.rms); }),
        of_record("rectification_mgal", [](R r) { return cell(r.rectification); }),
        of_record("eemd_mgal", [](R r) { return cell(r.eemd_mean); }),
        of_record("smoother_mgal", [](R r) { return cell(r.smoother_mean); }),
        of_record("u_smoother_mgal", [](R r) { return cell(r.smoother_standard_error); }),
        of_record("smoother_minus_eemd_mgal", [](R r) { return cell(r.smoother_minus_eemd()); }),
    };
}

Column<model::CorrectedRow> tilt_column() {
    return {"tilt_correction_mgal",
            of(&model::CorrectedRow::tilt_correction),
            {text::marked("Tilt corr.")}};
}

/// Returns the last columns of occupations.csv.  Cells of CSV have no comma.
Columns columns_of_grades(const model::SurveyCorrection& result) {
    std::map<UtcTime, judgement::ReadingGrade> grades;  // the rows have different times
    const std::vector<judgement::ReadingGrade> of_rows = judgement::grade_readings(result);
    for (std::size_t i = 0; i < of_rows.size(); ++i) grades[result.rows[i].row.time] = of_rows[i];
    const auto name = [grades](const model::CorrectedRow& row) {
        return std::string(judgement::grade_name(grades.at(row.row.time).grade));
    };
    const auto reason = [grades](const model::CorrectedRow& row) {
        std::string text = judgement::reason_text(grades.at(row.row.time));
        std::replace(text.begin(), text.end(), ',', ';');
        return text;
    };
    return {{"grade", name, {text::marked("Grade"), 0, 'n'}}, {"grade_reason", reason}};
}

/// Returns the half width of the interval that contains 95 %.
Cell expanded_uncertainty(const model::StationValue& station) {
    if (!station.u_gravity || !station.coverage_factor) return {};
    return station.u_gravity->value() * *station.coverage_factor;
}

/// Returns the column of a contribution to u, which only the whole-day model gives.
Column<model::StationValue> part_column(std::string_view key, std::string_view heading,
                                        whole_day::ErrorSource source) {
    const auto cell_of = [source](const model::StationValue& station) -> Cell {
        if (!station.errors) return {};
        return station.errors->parts_mgal.at(static_cast<std::size_t>(source));
    };
    return {key, cell_of, {heading, 2}};
}

Column<model::StationValue> anomaly_column(std::string_view key, std::string_view heading,
                                           MilliGal model::Anomalies::*member) {
    const auto cell_of = [member](const model::StationValue& station) {
        return station.anomalies ? cell((*station.anomalies).*member) : Cell();
    };
    return {key, cell_of, {heading}};
}

Columns columns_of_day() {
    using Day = model::WholeDayRow;
    return {of_model("averaged_s", &Day::averaged_s, {"s", 0}),
            of_model("fast_rate_degc_per_h", &Day::fast_rate_degc_per_h, {"degC/h"}), tilt_column(),
            of_model("flicker_correction_mgal", &Day::flicker_correction,
                     {text::marked("Flicker corr.")}),
            of_model("left_out_mgal", &Day::left_out, {text::marked("Left out")})};
}

}  // namespace

std::vector<Column<model::CorrectedRow>> occupation_columns(const model::SurveyCorrection& result) {
    using Row = const model::CorrectedRow&;
    Columns columns{
        {"site", [](Row row) { return row.row.site; }, {text::marked("Site"), 0, 'n'}},
        {"occupation",
         [](Row row) { return static_cast<std::int64_t>(row.row.occupation); },
         {text::marked("Occ.")}},
        {"time_utc",
         [](Row row) { return cell(row.row.time); },
         {text::marked("Time UTC"), 0, 'n'}},
        {"start_utc", [](Row row) { return cell(row.row.start); }},
        {"end_utc", [](Row row) { return cell(row.row.end); }},
        {"used", of(&model::CorrectedRow::is_used), {text::marked("In fit"), 0, 'l'}},
        {"flags",
         [&result](Row row) { return flags_of(row, result.options); },
         {text::marked("Flags"), 0, 'l'}},
        {"acceleration_mgal",
         [](Row row) { return cell(row.row.measured()); },
         {text::marked("Acceleration")}},
        {"temperature_degc",
         [](Row row) {
             return row.row.has_temperature ? Cell(row.row.temperature.value()) : Cell();
         },
         {"T degC"}},
        {"rate_degc_per_h", [](Row row) { return row.row.rate_degc_per_h; }, {"degC/h"}},
        {"tide_mgal", [](Row row) { return cell(row.row.tide); }, {text::marked("Tide")}},
        {"difference_mgal", of(&model::CorrectedRow::difference), {text::marked("Difference")}},
        {"temperature_correction_mgal",
         of(&model::CorrectedRow::temperature_correction),
         {text::marked("T corr.")}},
        {"rate_correction_mgal",
         of(&model::CorrectedRow::rate_correction),
         {text::marked("Rate corr.")}},
        {"drift_correction_mgal",
         of(&model::CorrectedRow::drift_correction),
         {text::marked("Drift corr.")}},
        {"corrected_mgal", of(&model::CorrectedRow::corrected), {text::marked("Corrected")}},
        {"reference_mgal",
         [](Row row) { return cell(row.row.reference); },
         {text::marked("Reference")}},
        {"residual_mgal", of(&model::CorrectedRow::residual), {text::marked("Residual")}},
        {"leverage", of(&model::CorrectedRow::leverage)},
        {"u_corrected_mgal", of(&model::CorrectedRow::u_corrected), {"u", 2}},
        {"studentised_residual", of(&model::CorrectedRow::studentised_residual), {"t", 2}},
        of_model("corrected1_mgal", &model::PaperRow::corrected1),
        // The publication's Error (1) (Table 2); residual_mgal is its Error (2).
        of_model("residual1_mgal", &model::PaperRow::residual1),
    };
    const model::CorrectedRow& first = result.rows.front();
    if (first.row.height_correction)
        append(columns, {{"instrument_height_m",
                          [](Row row) {
                              const auto height = row.row.instrument_height;
                              return height ? Cell(height->value()) : Cell();
                          }},
                         {"height_correction_mgal",
                          [](Row row) { return cell(row.row.height_correction); },
                          {"Height corr."}}});
    if (first.row.pressure_correction)
        append(columns, {{"pressure_hpa", [](Row row) { return cell(row.row.pressure_hpa); }},
                         {"pressure_correction_mgal",
                          [](Row row) { return cell(row.row.pressure_correction); },
                          {"Pressure corr.", 4}}});
    if (first.scale_correction)
        columns.push_back({"scale_correction_mgal",
                           of(&model::CorrectedRow::scale_correction),
                           {text::marked("Scale corr.")}});
    if (!first.row.instrument.empty())
        append(columns, {{"instrument",
                          [](Row row) { return row.row.instrument; },
                          {text::marked("Instrument"), 0, 'n'}},
                         {"loop",
                          [](Row row) { return static_cast<std::int64_t>(row.row.loop); },
                          {text::marked("Loop")}}});
    if (first.row.record) append(columns, columns_of_records());
    if (first.as<model::WholeDayRow>() != nullptr)
        append(columns, columns_of_day());
    else if (first.tilt_correction)
        columns.push_back(tilt_column());
    columns.push_back({"doubt_physical", of(&model::CorrectedRow::doubt_physical)});
    append(columns, columns_of_grades(result));
    return columns;
}

std::vector<Column<model::StationValue>> station_columns(
    const std::vector<model::StationValue>& stations) {
    std::vector<Column<model::StationValue>> columns{
        {"site", of(&model::StationValue::site), {text::marked("Station"), 0, 'n'}},
        {"n", of(&model::StationValue::row_count), {"n"}},
        {"gravity_mgal", of(&model::StationValue::gravity), {text::marked("Gravity mGal")}},
        {"u_gravity_mgal", of(&model::StationValue::u_gravity), {"u mGal", 2}},
        {"reference_mgal", of(&model::StationValue::reference), {text::marked("Reference mGal")}},
        {"residual_mgal", of(&model::StationValue::residual), {text::marked("Residual mGal")}},
        {"redundancy", of(&model::StationValue::redundancy), {text::marked("Redundancy"), 2}},
        {"flagged_only",
         of(&model::StationValue::is_flagged_only),
         {text::marked("Flagged only"), 0, 'l'}},
        {"u_a_posteriori_mgal", of(&model::StationValue::u_a_posteriori)},
        {"left_out_mgal", of(&model::StationValue::left_out), {text::marked("Left out mGal")}},
        {"u_left_out_mgal", of(&model::StationValue::u_left_out)},
        {"dof", of(&model::StationValue::dof)},
        {"k_95", of(&model::StationValue::coverage_factor)},
        {"expanded_u_mgal", expanded_uncertainty, {text::marked("U 95 % mGal"), 2}},
        part_column("u_placement_mgal", text::marked("Placement"),
                    whole_day::ErrorSource::placement),
        part_column("u_flicker_mgal", text::marked("Flicker"), whole_day::ErrorSource::flicker),
        part_column("u_white_mgal", text::marked("White"), whole_day::ErrorSource::white),
        part_column("u_levelling_mgal", text::marked("Levelling"),
                    whole_day::ErrorSource::levelling),
        part_column("u_thermal_mgal", text::marked("Thermal"), whole_day::ErrorSource::thermal),
        part_column("u_drift_mgal", text::marked("Drift"), whole_day::ErrorSource::drift),
        part_column("u_datum_mgal", text::marked("Datum"), whole_day::ErrorSource::datum),
        part_column("u_scale_mgal", text::marked("Scale"), whole_day::ErrorSource::scale),
    };
    if (std::ranges::any_of(stations, [](const auto& one) { return one.anomalies.has_value(); }))
        for (auto& column : {anomaly_column("normal_gravity_mgal", text::marked("Normal mGal"),
                                            &model::Anomalies::normal_gravity),
                             anomaly_column("free_air_anomaly_mgal", text::marked("Free air mGal"),
                                            &model::Anomalies::free_air),
                             anomaly_column("bouguer_anomaly_mgal", text::marked("Bouguer mGal"),
                                            &model::Anomalies::bouguer)})
            columns.push_back(column);
    return columns;
}

std::vector<Column<model::StationDifference>> difference_columns() {
    using Row = const model::StationDifference&;
    return {
        {"from", of(&model::StationDifference::from)},
        {"to", of(&model::StationDifference::to)},
        {"difference_mgal", of(&model::StationDifference::difference)},
        {"u_difference_mgal", of(&model::StationDifference::u)},
        {"reference_difference_mgal", of(&model::StationDifference::reference)},
        {"residual_mgal",
         [](Row row) { return row.reference ? cell(*row.reference - row.difference) : Cell(); }},
    };
}

std::vector<Column<ScoreRow>> score_columns(const model::SurveyCorrection& result) {
    using Row = const ScoreRow&;
    return {
        {"model", [](Row row) { return row.score->model; }, {text::marked("Model"), 0, 'n'}},
        {"rows", [](Row row) { return row.set->rows; }, {text::marked("Rows"), 0, 'l'}},
        {"n", [](Row row) { return cell_of_count(row.score->row_count); }, {"n"}},
        {"p", [](Row row) { return cell_of_count(row.score->parameter_count); }, {"p"}},
        {"rms_mgal",
         [](Row row) { return cell(row.score->rms_mgal); },
         {text::marked("RMS mGal (in sample)")}},
        {"s_mgal",
         [](Row row) { return cell(row.score->s_mgal); },
         {text::marked("s mGal (in sample)")}},
        {"loo_mgal",
         [](Row row) { return cell(row.score->loo_mgal); },
         {text::marked("LOO mGal (cross-validated)")}},
        {"loso_mgal",
         [](Row row) { return cell(row.score->loso_mgal); },
         {text::marked("LOSO mGal (cross-validated)")}},
        {"aicc", [](Row row) { return cell(row.score->aicc); }, {"AICc", 2}},
        {"selected",
         [&result](Row row) { return is_selected(result, row); },
         {text::marked("Applied"), 0, 'l'}},
        {"rms_before_drift_mgal", [](Row row) { return cell(row.score->rms_before_drift_mgal); }},
        {"dof", [](Row row) { return cell_of_count(row.score->dof); }, {"dof"}},
        {"calibration",
         [&result](Row row) { return std::string(model::calibration_in(result, *row.score)); }},
    };
}

}  // namespace a351::corrector::result
