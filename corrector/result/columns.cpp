#include "corrector/result/columns.hpp"

#include "corrector/model/calibration_use.hpp"

namespace a351::corrector {
namespace {

using Columns = std::vector<Column<CorrectedRow>>;

void append(Columns& columns, Columns more) {
    columns.insert(columns.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
}

Column<CorrectedRow> of_record(std::string_view key, Cell (*value)(const RecordSummary&)) {
    return {key, [value](const CorrectedRow& row) { return value(row.row.record.value()); }};
}

Column<CorrectedRow> of_shape(std::string_view key, TemperatureShape shape) {
    return {key, [shape](const CorrectedRow& row) {
                return row.row.record.value().temperature_shape == shape ? 1.0 : 0.0;
            }};
}

Column<CorrectedRow> of_day(std::string_view key, Cell (*value)(const WholeDayPart&)) {
    return {key, [value](const CorrectedRow& row) { return value(row.day.value()); }};
}

Columns columns_of_records() {
    using R = const RecordSummary&;
    return {
        of_record("series_mean_mgal", [](R r) { return cell(r.series_mean); }),
        of_record("series_minus_curve_mgal",
                  [](R r) { return cell(r.series_mean - r.curve_mean); }),
        of_record("standard_error_mgal", [](R r) { return cell(r.standard_error); }),
        of_record("temperature_range_degc", [](R r) { return cell(r.temperature_range.value()); }),
        of_shape("temperature_is_monotone", TemperatureShape::monotone),
        of_shape("temperature_is_half_wave", TemperatureShape::half_wave),
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

Column<CorrectedRow> tilt_column() {
    return {"tilt_correction_mgal",
            [](const CorrectedRow& row) { return cell(row.tilt_correction); }};
}

Columns columns_of_day() {
    using D = const WholeDayPart&;
    return {of_day("averaged_s", [](D day) { return cell(day.averaged_s); }),
            of_day("fast_rate_degc_per_h", [](D day) { return cell(day.fast_rate_degc_per_h); }),
            tilt_column(),
            of_day("flicker_correction_mgal", [](D day) { return cell(day.flicker_correction); }),
            of_day("left_out_mgal", [](D day) { return cell(day.left_out); })};
}

}  // namespace

std::vector<Column<CorrectedRow>> occupation_columns(const SurveyCorrection& result) {
    using Row = const CorrectedRow&;
    Columns columns{
        {"site", [](Row row) { return row.row.site; }},
        {"occupation", [](Row row) { return static_cast<std::int64_t>(row.row.occupation); }},
        {"time_utc", [](Row row) { return cell(row.row.time); }},
        {"start_utc", [](Row row) { return cell(row.row.start); }},
        {"end_utc", [](Row row) { return cell(row.row.end); }},
        {"used", [](Row row) { return row.is_used; }},
        {"flags", [&result](Row row) { return flags_of(row, result.options); }},
        {"acceleration_mgal", [](Row row) { return cell(row.row.acceleration); }},
        {"temperature_degc", [](Row row) { return row.row.temperature.value(); }},
        {"rate_degc_per_h", [](Row row) { return row.row.rate_degc_per_h; }},
        {"tide_mgal", [](Row row) { return cell(row.row.tide); }},
        {"difference_mgal", [](Row row) { return cell(row.difference); }},
        {"temperature_correction_mgal", [](Row row) { return cell(row.temperature_correction); }},
        {"rate_correction_mgal", [](Row row) { return cell(row.rate_correction); }},
        {"drift_correction_mgal", [](Row row) { return cell(row.drift_correction); }},
        {"corrected_mgal", [](Row row) { return cell(row.corrected); }},
        {"reference_mgal", [](Row row) { return cell(row.row.reference); }},
        {"residual_mgal", [](Row row) { return cell(row.residual); }},
        {"leverage", [](Row row) { return cell(row.leverage); }},
        {"u_corrected_mgal", [](Row row) { return cell(row.u_corrected); }},
        {"studentised_residual", [](Row row) { return cell(row.studentised_residual); }},
        {"corrected1_mgal", [](Row row) { return cell(row.corrected1); }},
        {"residual1_mgal", [](Row row) { return cell(row.residual1()); }},
    };
    const CorrectedRow& first = result.rows.front();
    if (first.row.record) append(columns, columns_of_records());
    if (first.day)
        append(columns, columns_of_day());
    else if (first.tilt_correction)
        columns.push_back(tilt_column());
    append(columns, {{"weight", [](Row row) { return cell(row.weight); }},
                     {"doubt_physical", [](Row row) { return row.doubt_physical; }},
                     {"doubt_statistical", [](Row row) { return row.doubt_statistical; }}});
    return columns;
}

std::vector<Column<StationValue>> station_columns() {
    using Station = const StationValue&;
    return {
        {"site", [](Station station) { return station.site; }},
        {"n", [](Station station) { return cell_of_count(station.row_count); }},
        {"gravity_mgal", [](Station station) { return cell(station.gravity); }},
        {"u_gravity_mgal", [](Station station) { return cell(station.u_gravity); }},
        {"reference_mgal", [](Station station) { return cell(station.reference); }},
        {"residual_mgal", [](Station station) { return cell(station.residual); }},
        {"redundancy", [](Station station) { return cell(station.redundancy); }},
        {"flagged_only", [](Station station) { return station.is_flagged_only; }},
        {"u_a_posteriori_mgal", [](Station station) { return cell(station.u_a_posteriori); }},
    };
}

std::vector<Column<ScoreRow>> score_columns(const SurveyCorrection& result) {
    using Row = const ScoreRow&;
    return {
        {"model", [](Row row) { return row.score->model; }},
        {"rows", [](Row row) { return row.set->rows; }},
        {"n", [](Row row) { return cell_of_count(row.score->row_count); }},
        {"p", [](Row row) { return cell_of_count(row.score->parameter_count); }},
        {"rms_mgal", [](Row row) { return cell(row.score->rms_mgal); }},
        {"s_mgal", [](Row row) { return cell(row.score->s_mgal); }},
        {"loo_mgal", [](Row row) { return cell(row.score->loo_mgal); }},
        {"loso_mgal", [](Row row) { return cell(row.score->loso_mgal); }},
        {"aicc", [](Row row) { return cell(row.score->aicc); }},
        {"selected", [&result](Row row) { return is_selected(result, row); }},
        {"rms_before_drift_mgal", [](Row row) { return cell(row.score->rms_before_drift_mgal); }},
        {"dof", [](Row row) { return cell_of_count(row.score->dof); }},
        {"calibration",
         [&result](Row row) { return std::string(calibration_in(result, *row.score)); }},
    };
}

}  // namespace a351::corrector
