#include "corrector/history/unit_history.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>

#include "corrector/model/model.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/catalogue.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::corrector::history {
namespace {

using nlohmann::json;

std::optional<double> number_or_none(const json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

/// Returns the UTC of a text; std::invalid_argument names a text that is none.
UtcTime instant_of(const std::string& text) {
    const auto time = parse_rfc3339(text);
    if (!time) throw std::invalid_argument("start_utc = " + text);
    return *time;
}

UnitDay read_unit_day(const std::filesystem::path& given) {
    const auto file = std::filesystem::is_directory(given) ? given / "result.json" : given;
    const auto refuse = [&file](const std::string& trouble) {
        return InputError(
            fmt::format("{}: {}; allowed: the result.json of a survey corrected with the model day",
                        file.string(), trouble));
    };
    const std::string content = text::read_text_file(file);
    try {
        const json result = json::parse(content);
        const json& settings = result.at("settings");
        const std::string model = result.at("model").get<std::string>();
        if (model != model::kWholeDay) throw refuse("model = " + model);
        UnitDay day;
        const json& serial = settings.at("serial_number");
        if (serial.is_null()) throw refuse("serial_number: not in the metadata of the record");
        day.serial_number = serial.get<std::string>();
        day.name = settings.at("name").get<std::string>();
        day.start = UtcTime::max();
        for (const json& row : result.at("occupations"))
            day.start = std::min(day.start, instant_of(row.at("start_utc").get<std::string>()));
        if (day.start == UtcTime::max()) throw std::invalid_argument("no occupation");
        day.loso_mgal = number_or_none(result.at("cross_validated").at("loso_mgal"));
        if (const json& fit = result.at("goodness_of_fit"); !fit.is_null())
            day.uncertainty_factor = number_or_none(fit.at("uncertainty_factor"));
        std::map<std::string, Term> terms;
        for (const json& term : result.at("coefficients")) {
            if (term.at("value").is_null()) continue;
            terms[term.at("name").get<std::string>()] = {term.at("value").get<double>(),
                                                         number_or_none(term.at("standard_error"))};
        }
        for (const TermKind& kind : term_kinds()) {
            const auto found = terms.find(std::string(kind.name));
            day.terms.push_back(found == terms.end() ? std::nullopt : std::optional(found->second));
        }
        return day;
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw refuse(std::string("not such a file (") + error.what() + ")");
    }
}

/// Returns the root of the mean of the squares; std::nullopt without numbers.
std::optional<double> rms_of(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / static_cast<double>(values.size()));
}

TermSummary summary_of(const std::vector<Term>& terms) {
    TermSummary summary;
    summary.day_count = terms.size();
    const auto count = static_cast<double>(terms.size());
    std::vector<double> u;
    for (const Term& term : terms) {
        summary.mean += term.value / count;
        if (term.u) u.push_back(*term.u);
    }
    summary.rms_u = rms_of(u);
    if (terms.size() > 1) {
        double squares = 0.0;
        for (const Term& term : terms) squares += std::pow(term.value - summary.mean, 2);
        summary.scatter = std::sqrt(squares / (count - 1.0));
    }
    return summary;
}

}  // namespace

const std::vector<TermKind>& term_kinds() {
    static const std::vector<TermKind> kinds{
        {"constant_mgal", "u_constant_mgal", text::marked("Constant mGal"), 2},
        {"temperature_mgal_per_degc", "u_temperature_mgal_per_degc",
         text::marked("Static slope mGal/degC"), 1},
        {"slow_temperature_mgal_per_degc", "u_slow_temperature_mgal_per_degc",
         text::marked("Slow slope mGal/degC"), 1},
        {"rate_mgal_per_degc_per_h", "u_rate_mgal_per_degc_per_h",
         text::marked("Fast term mGal/(degC/h)"), 2},
        {"fast_lag_s", "u_fast_lag_s", text::marked("Fast lag s"), 0},
        {"slow_lag_s", "u_slow_lag_s", text::marked("Slow lag s"), 0},
        {"time_mgal_per_h", "u_time_mgal_per_h", text::marked("Drift mGal/h"), 3},
        {"scale", "u_scale", text::marked("Scale"), 5},
        {"placement_mgal", "u_placement_mgal", text::marked("Placement mGal"), 2},
        {"flicker_mgal", "u_flicker_mgal", text::marked("Flicker mGal"), 2},
        {"white_mgal", "u_white_mgal", text::marked("White noise mGal"), 2}};
    return kinds;
}

std::vector<UnitDay> read_unit_days(const std::vector<std::filesystem::path>& results) {
    std::vector<UnitDay> days;
    std::map<std::pair<std::string, UtcTime>, std::filesystem::path> files;
    for (const std::filesystem::path& result : results) {
        days.push_back(read_unit_day(result));
        const UnitDay& day = days.back();
        const auto [other, is_new] = files.try_emplace({day.serial_number, day.start}, result);
        if (!is_new) {
            throw InputError(
                fmt::format("{} and {}: the same day of unit {}; allowed: one result of each day",
                            other->second.string(), result.string(), day.serial_number));
        }
    }
    std::ranges::sort(days, {},
                      [](const UnitDay& day) { return std::tie(day.serial_number, day.start); });
    return days;
}

const std::vector<result::Column<UnitDay>>& unit_day_columns() {
    static const std::vector<result::Column<UnitDay>> columns = [] {
        using result::of;
        std::vector<result::Column<UnitDay>> all{
            {"serial_number", of(&UnitDay::serial_number), {text::marked("Unit"), 0, 'n'}},
            {"start_utc", of(&UnitDay::start), {text::marked("First reading UTC"), 0, 'n'}},
            {"name", of(&UnitDay::name), {text::marked("Day"), 0, 'n'}},
            {"loso_mgal", of(&UnitDay::loso_mgal), {text::marked("Left out mGal"), 2}},
            {"uncertainty_factor", of(&UnitDay::uncertainty_factor), {}}};
        for (std::size_t k = 0; k < term_kinds().size(); ++k) {
            const TermKind& kind = term_kinds()[k];
            all.push_back({kind.name,
                           [k](const UnitDay& day) {
                               const auto& term = day.terms[k];
                               return term ? result::cell(term->value) : result::Cell();
                           },
                           {kind.heading, kind.decimals}});
            all.push_back({kind.u_key,
                           [k](const UnitDay& day) {
                               const auto& term = day.terms[k];
                               return term ? result::cell(term->u) : result::Cell();
                           },
                           {}});
        }
        return all;
    }();
    return columns;
}

std::vector<TermSummary> summarise(const std::vector<UnitDay>& days) {
    std::vector<TermSummary> summaries;
    for (auto first = days.begin(); first != days.end();) {
        const auto end = std::find_if(first, days.end(), [&](const UnitDay& day) {
            return day.serial_number != first->serial_number;
        });
        for (std::size_t k = 0; k < term_kinds().size(); ++k) {
            std::vector<Term> terms;
            for (auto day = first; day != end; ++day)
                if (day->terms[k]) terms.push_back(*day->terms[k]);
            if (terms.empty()) continue;
            TermSummary& summary = summaries.emplace_back(summary_of(terms));
            summary.serial_number = first->serial_number;
            summary.term = term_kinds()[k].name;
        }
        first = end;
    }
    return summaries;
}

const std::vector<result::Column<TermSummary>>& term_summary_columns() {
    using result::of;
    static const std::vector<result::Column<TermSummary>> columns{
        {"serial_number", of(&TermSummary::serial_number), {text::marked("Unit"), 0, 'n'}},
        {"term", of(&TermSummary::term), {text::marked("Term"), 0, 'n'}},
        {"days", of(&TermSummary::day_count), {text::marked("Days")}},
        {"mean", of(&TermSummary::mean), {text::marked("Mean"), 4}},
        {"scatter", of(&TermSummary::scatter), {text::marked("Scatter of a day"), 4}},
        {"rms_u", of(&TermSummary::rms_u), {text::marked("u of a day"), 4}}};
    return columns;
}

}  // namespace a351::corrector::history
