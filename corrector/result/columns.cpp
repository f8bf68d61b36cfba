#include "corrector/result/columns.hpp"

#include <algorithm>
#include <map>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/model/calibration_use.hpp"
#include "protocol/events/face.hpp"

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

/// Returns a column that only one model fills; its cells are empty for other models.
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
        {"key", of(&model::CorrectedRow::row, &reading::SurveyRow::key)},
        of_record("series_mean_mgal", [](R r) { return cell(r.series_mean); }),
        of_record("series_minus_curve_mgal",
                  [](R r) { return cell(r.series_mean - r.curve_mean); }),
        of_record("standard_error_mgal", [](R r) { return cell(r.standard_error); }),
        of_record("temperature_range_degc", [](R r) { return cell(r.temperature_range); }),
        of_shape("temperature_is_monotone", reading::TemperatureShape::monotone),
        of_shape("temperature_is_half_wave", reading::TemperatureShape::half_wave),
        of_record("valid_samples", [](R r) { return cell(static_cast<double>(r.counts.valid)); }),
        of_record("partial_samples",
                  [](R r) { return cell(static_cast<double>(r.counts.partial)); }),
        of_record("missing_samples",
                  [](R r) { return cell(static_cast<double>(r.counts.missing)); }),
        {"recorded_min",
         [](const model::CorrectedRow& row) -> Cell {
             return row.row.record.value().recorded_s / 60.0;
         },
         {text::marked("of min"), 1}},
        of_record("mean_x_g", [](R r) { return cell(r.x.mean); }),
        of_record("rms_x_mgal", [](R r) { return cell(r.x.rms); }),
        of_record("mean_y_g", [](R r) { return cell(r.y.mean); }),
        of_record("rms_y_mgal", [](R r) { return cell(r.y.rms); }),
        of_record("mean_z_g", [](R r) { return cell(r.z.mean); }),
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

Columns columns_of_day() {
    using Day = model::WholeDayRow;
    return {of_model("averaged_s", &Day::averaged_s, {"s", 0}),
            of_model("fast_rate_degc_per_h", &Day::fast_rate_degc_per_h, {"degC/h"}), tilt_column(),
            of_model("flicker_correction_mgal", &Day::flicker_correction,
                     {text::marked("Flicker corr.")}),
            of_model("left_out_mgal", &Day::left_out, {text::marked("Left out")})};
}

}  // namespace

std::optional<double> used_minutes(const model::CorrectedRow& row) {
    constexpr double kMinute_s = 60.0;
    const auto* const day = row.as<model::WholeDayRow>();
    if (day != nullptr) return day->averaged_s / kMinute_s;
    if (!row.row.start || !row.row.end) return std::nullopt;
    return seconds_between(*row.row.start, *row.row.end) / kMinute_s;
}

std::vector<Column<model::CorrectedRow>> occupation_columns(const model::SurveyCorrection& result) {
    using Row = model::CorrectedRow;
    using Read = reading::SurveyRow;
    const auto read = [](auto member) { return of(&Row::row, member); };
    Columns columns{
        {"site", read(&Read::site), {text::marked("Site"), 0, 'n'}},
        {"occupation", read(&Read::occupation), {text::marked("Occ.")}},
        {"time_utc", read(&Read::time), {text::marked("Time UTC"), 0, 'n'}},
        {"start_utc", read(&Read::start)},
        {"end_utc", read(&Read::end)},
        {"used", of(&Row::is_used), {text::marked("In fit"), 0, 'l'}},
        {"flags",
         [&result](const Row& row) { return flags_of(row, result.options); },
         {text::marked("Flags"), 0, 'l'}},
        {"acceleration_mgal",
         [](const Row& row) { return cell(row.row.measured()); },
         {text::marked("Acceleration")}},
        {"temperature_degc",
         [](const Row& row) {
             return row.row.has_temperature ? cell(row.row.temperature) : Cell();
         },
         {"T degC"}},
        {"rate_degc_per_h", read(&Read::rate_degc_per_h), {"degC/h"}},
        {"tide_mgal", read(&Read::tide), {text::marked("Tide")}},
        {"difference_mgal", of(&Row::difference), {text::marked("Difference")}},
        {"temperature_correction_mgal",
         of(&Row::temperature_correction),
         {text::marked("T corr.")}},
        {"rate_correction_mgal", of(&Row::rate_correction), {text::marked("Rate corr.")}},
        {"drift_correction_mgal", of(&Row::drift_correction), {text::marked("Drift corr.")}},
        {"corrected_mgal", of(&Row::corrected), {text::marked("Corrected")}},
        {"reference_mgal", read(&Read::reference), {text::marked("Reference")}},
        {"residual_mgal", of(&Row::residual), {text::marked("Residual")}},
        {"leverage", of(&Row::leverage)},
        {"u_corrected_mgal", of(&Row::u_corrected), {"u", 2}},
        {"studentised_residual", of(&Row::studentised_residual), {"t", 2}},
        of_model("corrected1_mgal", &model::PaperRow::corrected1),
        // The publication's Error (1) and (2) (Table 2) are -residual1_mgal and -residual_mgal.
        of_model("residual1_mgal", &model::PaperRow::residual1),
    };
    const model::CorrectedRow& first = result.rows.front();
    if (first.row.height_correction)
        append(columns,
               {{"instrument_height_m", read(&Read::instrument_height)},
                {"height_correction_mgal", read(&Read::height_correction), {"Height corr."}}});
    if (first.row.pressure_correction)
        append(columns, {{"pressure_hpa", read(&Read::pressure_hpa)},
                         {"pressure_correction_mgal",
                          read(&Read::pressure_correction),
                          {"Pressure corr.", 4}}});
    if (first.scale_correction)
        columns.push_back(
            {"scale_correction_mgal", of(&Row::scale_correction), {text::marked("Scale corr.")}});
    if (!first.row.instrument.empty())
        append(columns, {{"instrument", read(&Read::instrument)}, {"loop", read(&Read::loop)}});
    if (first.row.start)
        columns.push_back({"used_min",
                           [](const Row& row) { return cell(used_minutes(row)); },
                           {text::marked("Min used"), 1}});
    if (model::has_two_faces(result.rows))
        columns.push_back(
            {"face",
             [](const Row& row) -> Cell { return std::string(events::sign_of(row.row.face)); },
             {text::marked("Face"), 0, 'l'}});
    if (first.row.record) append(columns, columns_of_records());
    if (first.as<model::WholeDayRow>() != nullptr)
        append(columns, columns_of_day());
    else if (first.tilt_correction)
        columns.push_back(tilt_column());
    columns.push_back({"doubt_physical", of(&Row::doubt_physical)});
    append(columns, columns_of_grades(result));
    return columns;
}

std::vector<Column<model::StationValue>> station_columns(
    const std::vector<model::StationValue>& stations) {
    using Row = model::StationValue;
    std::vector<Column<Row>> columns{
        {"site", of(&Row::site), {text::marked("Station"), 0, 'n'}},
        {"n", of(&Row::row_count), {"n"}},
        {"gravity_mgal", of(&Row::gravity), {text::marked("Gravity mGal")}},
        {"u_gravity_mgal", of(&Row::u_gravity), {"u mGal", 2}},
        {"reference_mgal", of(&Row::reference), {text::marked("Reference mGal")}},
        {"residual_mgal", of(&Row::residual), {text::marked("Residual mGal")}},
        {"redundancy", of(&Row::redundancy), {text::marked("Redundancy"), 2}},
        {"flagged_only", of(&Row::is_flagged_only), {text::marked("Flagged only"), 0, 'l'}},
        {"u_a_posteriori_mgal", of(&Row::u_a_posteriori)},
        {"left_out_mgal", of(&Row::left_out), {text::marked("Left out mGal")}},
        {"u_left_out_mgal", of(&Row::u_left_out)},
        {"dof", of(&Row::dof)},
        {"k_95", of(&Row::coverage_factor)},
        {"expanded_u_mgal", expanded_uncertainty, {text::marked("U 95 % mGal"), 2}},
    };
    append_contributions(columns, [](const Row& station) {
        return station.parts_mgal ? &*station.parts_mgal : nullptr;
    });
    if (std::ranges::none_of(stations, [](const Row& one) { return one.anomalies.has_value(); }))
        return columns;
    const auto anomaly = [](auto member) { return of(&Row::anomalies, member); };
    using model::Anomalies;
    columns.insert(
        columns.end(),
        {{"normal_gravity_mgal",
          anomaly(&Anomalies::normal_gravity),
          {text::marked("Normal mGal")}},
         {"free_air_anomaly_mgal", anomaly(&Anomalies::free_air), {text::marked("Free air mGal")}},
         {"bouguer_anomaly_mgal", anomaly(&Anomalies::bouguer), {text::marked("Bouguer mGal")}}});
    return columns;
}

std::vector<Column<model::StationDifference>> difference_columns() {
    using Row = model::StationDifference;
    const auto residual = [](const Row& row) {
        return row.reference ? cell(row.difference - *row.reference) : Cell();
    };
    return {
        {"from", of(&Row::from)},
        {"to", of(&Row::to)},
        {"difference_mgal", of(&Row::difference)},
        {"u_difference_mgal", of(&Row::u)},
        {"reference_difference_mgal", of(&Row::reference)},
        {"residual_mgal", residual},
    };
}

std::vector<Column<ScoreRow>> score_columns(const model::SurveyCorrection& result) {
    using model::Score;
    const auto score = [](auto member) { return of(&ScoreRow::score, member); };
    const auto rows = of(&ScoreRow::set, &model::ScoredRowSet::rows);
    const auto selected = [&result](const ScoreRow& row) { return is_selected(result, row); };
    const auto calibration = [&result](const ScoreRow& row) {
        return std::string(model::calibration_in(result, *row.score));
    };
    return {
        {"model", score(&Score::model), {text::marked("Model"), 0, 'n'}},
        {"rows", rows, {text::marked("Rows"), 0, 'l'}},
        {"n", score(&Score::row_count), {"n"}},
        {"p", score(&Score::parameter_count), {"p"}},
        {"rms_mgal", score(&Score::rms_mgal), {text::marked("RMS mGal (in sample)"), 2}},
        {"s_mgal", score(&Score::s_mgal), {text::marked("s mGal (in sample)"), 2}},
        {"loo_mgal", score(&Score::loo_mgal), {text::marked("LOO mGal (cross-validated)"), 2}},
        {"loso_mgal", score(&Score::loso_mgal), {text::marked("LOSO mGal (cross-validated)"), 2}},
        {"aicc", score(&Score::aicc), {"AICc", 2}},
        {"selected", selected, {text::marked("Applied"), 0, 'l'}},
        {"rms_before_drift_mgal", score(&Score::rms_before_drift_mgal)},
        {"dof", score(&Score::dof), {"dof"}},
        {"calibration", calibration},
    };
}

}  // namespace a351::corrector::result
