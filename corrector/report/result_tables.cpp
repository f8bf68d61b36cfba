#include "corrector/report/result_tables.hpp"

#include <algorithm>
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

std::string hexadecimal(std::uint32_t value) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[value >> shift & 0xFU];
    return text;
}

}  // namespace

std::string stations_html(const SurveyCorrection& result) {
    const auto& stations = result.stations;
    const bool has_redundancy = std::any_of(stations.begin(), stations.end(),
                                            [](const auto& s) { return s.redundancy.has_value(); });
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
    const bool has_flagged = std::any_of(stations.begin(), stations.end(),
                                         [](const auto& s) { return s.is_flagged_only; });
    return html_table(alignment, header, rows) +
           html_paragraph(std::string("Residuals are in sample. u is a standard uncertainty, ") +
                          (result.model == "day" ? "as if the station were unknown."
                           : result.network      ? "a priori."
                                                 : "from the scatter in sample.") +
                          (has_flagged ? " * Only readings that were left out of the fit." : ""));
}

std::string closures_html(const SurveyCorrection& result) {
    const std::vector<Closure> closures = close_stations(result);
    if (closures.empty()) {
        return html_paragraph(
            "No station was read twice, so there are no closures; drift is visible only "
            "against the references.");
    }
    std::vector<HtmlCells> rows;
    rows.reserve(closures.size());
    for (const Closure& pair : closures) {
        rows.push_back({reading_name(result.rows, pair.earlier),
                        reading_name(result.rows, pair.later), text::fixed(pair.hours, 2),
                        number(pair.before), number(pair.after_tide),
                        number(pair.after_temperature), number(pair.after_rate),
                        number(pair.after_all), cell(pair.drift_mgal_per_h, 3)});
    }
    const ClosureRms rms = rms_of(closures).value();
    rows.push_back({"RMS of " + std::to_string(closures.size()), "", "", number(rms.before),
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
    for (const ScoredRowSet& set : result.row_sets) {
        for (const ModelScore& score : set.scores) {
            rows.push_back(score_cells(set, score));
            rows.back().push_back(is_selected(result, set, score) ? "applied" : "");
        }
    }
    std::string html =
        html_table("nlrrrrrrrrl",
                   {"Model", "Rows", "n", "p", "dof", "RMS mGal (in sample)", "s mGal (in sample)",
                    "RMS mGal (cross-validated, leave-one-out)",
                    "RMS mGal (cross-validated, leave-one-station-out)", "AICc", ""},
                   rows);
    if (result.choice) {
        html += html_paragraph(
            "Chosen: among the models within one standard error of the least "
            "leave-one-station-out error, up to " +
            text::fixed(result.choice->limit_mgal, 3) + " mGal, the one with the fewest terms.");
    }
    std::vector<HtmlCells> coefficients;
    for (const Coefficient& c : result.coefficients) {
        coefficients.push_back({c.name, text::fixed(c.value, 4), cell(c.standard_error, 4)});
    }
    return html + "<h3>Coefficients of " + result.model + "</h3>\n" +
           html_table("lrr", {"Coefficient", "Value", "Standard error"}, coefficients);
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
    files.reserve(inputs.size());
    for (const text::InputFile& input : inputs) {
        files.push_back(
            {input.role, input.name, std::to_string(input.byte_count), hexadecimal(input.crc32)});
    }
    return html + "<h3>Inputs</h3>\n" +
           html_table("llrr", {"Role", "File", "Bytes", "CRC-32"}, files);
}

}  // namespace a351::corrector
