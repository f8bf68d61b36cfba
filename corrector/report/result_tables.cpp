#include "corrector/report/result_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "corrector/figure/reading_name.hpp"
#include "corrector/report/closure.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {
namespace {

template <class Value>
std::string cell(const std::optional<Value>& value, int decimals) {
    return text::fixed_or(value, decimals, "-");
}

std::string number(MilliGal value, int decimals = 3) {
    return text::fixed(value.value(), decimals);
}

/// Returns date and time of the first instant, and time of the last.
std::string between(UtcTime start, UtcTime end) {
    const std::string text = to_rfc3339(start);
    return fmt::format("{} {}\u2013{}", text.substr(0, 10), text.substr(11, 8),
                       to_rfc3339(end).substr(11, 8));
}

std::string averaged_s(const CorrectedRow& row) {
    if (row.day) return text::fixed(row.day->averaged_s, 0);
    if (!row.row.start || !row.row.end) return "-";
    return text::fixed(seconds_between(*row.row.start, *row.row.end), 0);
}

struct PageColumn {
    std::string title;
    char alignment = 'r';
    std::function<std::string(const CorrectedRow&)> cell;
};

std::vector<PageColumn> columns_of(const SurveyCorrection& result) {
    using Row = const CorrectedRow&;
    const bool is_day = result.model == "day";
    std::vector<PageColumn> columns;
    const auto add = [&columns](const char* title, std::function<std::string(Row)> value,
                                char alignment = 'r') {
        columns.push_back({title, alignment, std::move(value)});
    };
    if (result.rows.front().row.start) {
        const auto averaged = [](Row row) {
            return row.row.start && row.row.end ? between(*row.row.start, *row.row.end) : "-";
        };
        add("Averaged UTC", averaged, 'n');
        add("s", averaged_s);
    } else {
        add(
            "Time UTC", [](Row row) { return to_rfc3339(row.row.time); }, 'n');
    }
    add(
        "In fit", [](Row row) { return row.is_used ? "yes" : "no"; }, 'l');
    add("Acceleration", [](Row row) { return number(row.row.acceleration); });
    add("T °C", [](Row row) { return text::fixed(row.row.temperature.value(), 3); });
    add("°C/h", [is_day](Row row) {
        return text::fixed(is_day ? row.day.value().fast_rate_degc_per_h : row.row.rate_degc_per_h,
                           3);
    });
    add("Tide", [](Row row) { return number(row.row.tide); });
    add("T corr.", [](Row row) { return number(row.temperature_correction); });
    add("Rate corr.", [](Row row) { return number(row.rate_correction); });
    add("Drift corr.", [](Row row) { return number(row.drift_correction); });
    if (is_day) {
        add("Tilt corr.", [](Row row) { return cell(row.tilt_correction, 3); });
        add("Flicker corr.", [](Row row) { return number(row.day.value().flicker_correction); });
    }
    add("Corrected", [](Row row) { return number(row.corrected); });
    add("Reference", [](Row row) { return cell(row.row.reference, 3); });
    add("Residual", [](Row row) { return cell(row.residual, 3); });
    if (is_day) add("Left out", [](Row row) { return cell(row.day.value().left_out, 3); });
    add("u", [](Row row) { return cell(row.u_corrected, 2); });
    add("t", [](Row row) { return cell(row.studentised_residual, 2); });
    add(
        "Flags", [&result](Row row) { return flags_of(row, result.options); }, 'l');
    return columns;
}

std::string explanation(const SurveyCorrection& result) {
    const std::string text =
        "Accelerations, gravity, corrections, residuals and u in mGal. Corrected = acceleration - "
        "tide + corrections; residual = reference - corrected (in sample where the reading is in "
        "the fit). ";
    if (result.model != "day")
        return fmt::format("{}u is that of a {}; t is the studentised residual.", text,
                           result.network ? "single reading, a priori" : "new station");
    return text +
           "The model day averages all undisturbed samples between the two instants; column s is "
           "their duration in seconds. °C/h is the rate that its fast term uses. The residual is "
           "placement, one value for every set-up. Left out: value of the reading if its "
           "station's reference is not used. u is the uncertainty of this value; t = (reference - "
           "left out) / u.";
}

}  // namespace

std::string stations_html(const SurveyCorrection& result) {
    const auto& stations = result.stations;
    const bool has_redundancy =
        std::ranges::any_of(stations, [](const auto& s) { return s.redundancy.has_value(); });
    std::string alignment = "nrrrrr";
    HtmlCells header{"Station", "n", "Gravity mGal", "u mGal", "Reference mGal", "Residual mGal"};
    if (has_redundancy) {
        alignment += 'r';
        header.emplace_back("Redundancy");
    }
    std::vector<HtmlCells> rows;
    for (const StationValue& station : stations) {
        HtmlCells& cells = rows.emplace_back(HtmlCells{
            station.site + (station.is_flagged_only ? " *" : ""), std::to_string(station.row_count),
            number(station.gravity), cell(station.u_gravity, 2), cell(station.reference, 3),
            cell(station.residual, 3)});
        if (has_redundancy) cells.push_back(cell(station.redundancy, 2));
    }
    return html_table(alignment, header, rows) +
           html_paragraph(fmt::format("Residuals are in sample. u is a standard uncertainty, {}.{}",
                                      result.model == "day" ? "as if the station were unknown"
                                      : result.network      ? "a priori"
                                                            : "from the scatter in sample",
                                      std::ranges::any_of(stations, &StationValue::is_flagged_only)
                                          ? " * Only readings that were left out of the fit."
                                          : ""));
}

std::string occupations_html(const SurveyCorrection& result) {
    const std::vector<PageColumn> columns = columns_of(result);
    std::string alignment = "n";
    HtmlCells header{"Reading"};
    for (const PageColumn& column : columns) {
        alignment += column.alignment;
        header.push_back(column.title);
    }
    std::vector<HtmlCells> lines;
    const auto add_row = [&](std::size_t i) {
        HtmlCells& cells = lines.emplace_back(1, reading_name(result.rows, i));
        for (const PageColumn& column : columns) cells.push_back(column.cell(result.rows[i]));
    };
    in_order_of_time(result, add_row, [&](const LeftOut& stay) {
        HtmlCells& cells = lines.emplace_back(header.size(), "-");
        cells.front() = fmt::format("{} ({})", stay.site, stay.occupation);
        cells[1] =
            result.rows.front().row.start ? between(stay.start, stay.end) : to_rfc3339(stay.start);
        cells.back() = stay.reason;
    });
    return html_table(alignment, header, lines) + html_paragraph(explanation(result));
}

std::string closures_html(const SurveyCorrection& result) {
    const std::vector<Closure> closures = close_stations(result);
    if (closures.empty()) {
        return html_paragraph(
            "No station was read twice, so there are no closures; drift is visible only "
            "against the references.");
    }
    std::vector<HtmlCells> rows;
    for (const Closure& pair : closures) {
        rows.push_back({reading_name(result.rows, pair.earlier),
                        reading_name(result.rows, pair.later), text::fixed(pair.hours, 2),
                        number(pair.before), number(pair.after_tide),
                        number(pair.after_temperature), number(pair.after_rate),
                        number(pair.after_all), cell(pair.drift_mgal_per_h, 3)});
    }
    const ClosureRms rms = rms_of(closures).value();
    rows.push_back({fmt::format("RMS of {}", closures.size()), "", "", number(rms.before),
                    number(rms.after_tide), number(rms.after_temperature), number(rms.after_rate),
                    number(rms.after_all), ""});
    return html_table("nnrrrrrrr",
                      {"Earlier", "Later", "Hours", "As read", "After tide", "After temperature",
                       "After rate, tilt", "After drift (all)", "Drift mGal/h"},
                      rows) +
           html_paragraph(
               "Later minus earlier reading of one station, in mGal. Drift: value that each "
               "pair alone implies, from the difference after rate. The last differences are in "
               "sample, because the coefficients were fitted to the same readings.");
}

std::string models_html(const SurveyCorrection& result) {
    std::vector<HtmlCells> rows;
    for (const ScoreRow& row : score_rows(result)) {
        rows.push_back(score_cells(row));
        rows.back().push_back(is_selected(result, row) ? "applied" : "");
    }
    std::string html =
        html_table("nlrrrrrrrrl",
                   {"Model", "Rows", "n", "p", "dof", "RMS mGal (in sample)", "s mGal (in sample)",
                    "RMS mGal (cross-validated, leave-one-out)",
                    "RMS mGal (cross-validated, leave-one-station-out)", "AICc", ""},
                   rows);
    if (result.choice) {
        html += html_paragraph(fmt::format(
            "Chosen: among the models within one standard error of the least "
            "leave-one-station-out error, up to {} mGal, the one with the fewest terms.",
            text::fixed(result.choice->limit_mgal, 3)));
    }
    std::vector<HtmlCells> coefficients;
    for (const Coefficient& c : result.coefficients) {
        coefficients.push_back({c.name, text::fixed(c.value, 4), cell(c.standard_error, 4)});
    }
    return fmt::format("{}<h3>Coefficients of {}</h3>\n{}", html, result.model,
                       html_table("lrr", {"Coefficient", "Value", "Standard error"}, coefficients));
}

std::string provenance_html(const nlohmann::ordered_json& settings,
                            const std::vector<text::InputFile>& inputs,
                            const std::vector<std::string>& warnings) {
    std::string html = "<h3>Warnings</h3>\n";
    html += warnings.empty() ? html_paragraph("None.") : html_list(warnings);
    std::vector<HtmlCells> rows;
    for (const auto& [key, value] : settings.items()) {
        if (key == "warnings") continue;
        rows.push_back({key, value.is_string()
                                 ? value.get<std::string>()
                                 : value.dump(-1, ' ', false,
                                              nlohmann::ordered_json::error_handler_t::replace)});
    }
    rows.push_back({"program", "a351-correct " A351_VERSION});
    html += "<h3>Settings</h3>\n" + html_table("ll", {"Setting", "Value"}, rows);
    std::vector<HtmlCells> files;
    for (const text::InputFile& input : inputs) {
        files.push_back({input.role, input.name, std::to_string(input.byte_count),
                         fmt::format("{:08x}", input.crc32)});
    }
    return html + "<h3>Inputs</h3>\n" +
           html_table("llrr", {"Role", "File", "Bytes", "CRC-32"}, files);
}

}  // namespace a351::corrector
