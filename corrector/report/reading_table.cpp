#include "corrector/report/reading_table.hpp"

#include <functional>

#include "corrector/figure/reading_name.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

struct PageColumn {
    std::string title;
    char alignment = 'r';
    std::function<std::string(const CorrectedRow&)> cell;
};

/// Returns date and time of the first instant, and time of the last.
std::string between(UtcTime start, UtcTime end) {
    const std::string text = to_rfc3339(start);
    return text.substr(0, 10) + ' ' + text.substr(11, 8) + "\u2013" + to_rfc3339(end).substr(11, 8);
}

std::string averaged_between(const CorrectedRow& row) {
    if (!row.row.start || !row.row.end) return "-";
    return between(*row.row.start, *row.row.end);
}

std::string averaged_s(const CorrectedRow& row) {
    if (row.day) return text::fixed(row.day->averaged_s, 0);
    if (!row.row.start || !row.row.end) return "-";
    return text::fixed(seconds_between(*row.row.start, *row.row.end), 0);
}

PageColumn number(const std::string& title, MilliGal CorrectedRow::*value) {
    return {title, 'r',
            [value](const CorrectedRow& row) { return text::fixed((row.*value).value(), 3); }};
}

PageColumn number(const std::string& title, std::optional<MilliGal> CorrectedRow::*value,
                  int decimals) {
    return {title, 'r', [value, decimals](const CorrectedRow& row) {
                return text::fixed_or(row.*value, decimals, "-");
            }};
}

/// Returns a column of rows by the whole-day model.
PageColumn of_day(const std::string& title, double (*value)(const WholeDayPart&)) {
    return {title, 'r',
            [value](const CorrectedRow& row) { return text::fixed(value(row.day.value()), 3); }};
}

std::vector<PageColumn> columns_of(const SurveyCorrection& result) {
    const bool is_day = result.model == "day";
    std::vector<PageColumn> columns;
    if (result.rows.front().row.start) {
        columns.push_back({"Averaged UTC", 'n', averaged_between});
        columns.push_back({"s", 'r', averaged_s});
    } else {
        columns.push_back(
            {"Time UTC", 'n', [](const CorrectedRow& row) { return to_rfc3339(row.row.time); }});
    }
    columns.push_back({"In fit", 'l', [](const CorrectedRow& row) {
                           return std::string(row.is_used ? "yes" : "no");
                       }});
    columns.push_back({"Acceleration", 'r', [](const CorrectedRow& row) {
                           return text::fixed(row.row.acceleration.value(), 3);
                       }});
    columns.push_back({"T °C", 'r', [](const CorrectedRow& row) {
                           return text::fixed(row.row.temperature.value(), 3);
                       }});
    if (is_day) {
        columns.push_back(
            of_day("°C/h", [](const WholeDayPart& day) { return day.fast_rate_degc_per_h; }));
    } else {
        columns.push_back({"°C/h", 'r', [](const CorrectedRow& row) {
                               return text::fixed(row.row.rate_degc_per_h, 3);
                           }});
    }
    columns.push_back({"Tide", 'r', [](const CorrectedRow& row) {
                           return text::fixed(row.row.tide.value(), 3);
                       }});
    columns.push_back(number("T corr.", &CorrectedRow::temperature_correction));
    columns.push_back(number("Rate corr.", &CorrectedRow::rate_correction));
    columns.push_back(number("Drift corr.", &CorrectedRow::drift_correction));
    if (is_day) {
        columns.push_back(number("Tilt corr.", &CorrectedRow::tilt_correction, 3));
        columns.push_back(of_day("Flicker corr.", [](const WholeDayPart& day) {
            return day.flicker_correction.value();
        }));
    }
    columns.push_back(number("Corrected", &CorrectedRow::corrected));
    columns.push_back({"Reference", 'r', [](const CorrectedRow& row) {
                           return text::fixed_or(row.row.reference, 3, "-");
                       }});
    columns.push_back(number("Residual", &CorrectedRow::residual, 3));
    if (is_day) {
        columns.push_back({"Left out", 'r', [](const CorrectedRow& row) {
                               return text::fixed_or(row.day.value().left_out, 3, "-");
                           }});
    }
    columns.push_back(number("u", &CorrectedRow::u_corrected, 2));
    columns.push_back({"t", 'r', [](const CorrectedRow& row) {
                           return text::fixed_or(row.studentised_residual, 2, "-");
                       }});
    columns.push_back({"Flags", 'l', [&result](const CorrectedRow& row) {
                           return flags_of(row, result.options);
                       }});
    return columns;
}

std::string explanation(const SurveyCorrection& result) {
    std::string text =
        "Accelerations, gravity, corrections, residuals and u in mGal. Corrected = acceleration - "
        "tide + corrections; residual = reference - corrected (in sample where the reading is in "
        "the fit). ";
    if (result.model != "day")
        return text + "u " +
               (result.network ? "is that of a single reading, a priori"
                               : "is that of a new station") +
               "; t is the studentised residual.";
    return text +
           "The model day averages all undisturbed samples between the two instants; column s is "
           "their duration in seconds. °C/h is the rate that its fast term uses. The residual is "
           "placement, one value for every set-up. Left out: value of the reading if its "
           "station's reference is not used. u is the uncertainty of this value; t = (reference - "
           "left out) / u.";
}

}  // namespace

std::string occupations_html(const SurveyCorrection& result) {
    const std::vector<PageColumn> columns = columns_of(result);
    std::string alignment = "n";
    HtmlCells header{"Reading"};
    for (const PageColumn& column : columns) {
        alignment += column.alignment;
        header.push_back(column.title);
    }
    std::vector<HtmlCells> lines;
    auto left_out = result.left_out.begin();
    const auto add_left_out_before = [&](UtcTime time) {
        for (; left_out != result.left_out.end() && left_out->start < time; ++left_out) {
            HtmlCells& cells = lines.emplace_back(header.size(), "-");
            cells.front() = left_out->site + " (" + std::to_string(left_out->occupation) + ')';
            cells[1] = result.rows.front().row.start ? between(left_out->start, left_out->end)
                                                     : to_rfc3339(left_out->start);
            cells.back() = left_out->reason;
        }
    };
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        add_left_out_before(result.rows[i].row.time);
        HtmlCells& cells = lines.emplace_back(1, reading_name(result.rows, i));
        for (const PageColumn& column : columns) cells.push_back(column.cell(result.rows[i]));
    }
    add_left_out_before(UtcTime::max());
    return html_table(alignment, header, lines) + html_paragraph(explanation(result));
}

}  // namespace a351::corrector
