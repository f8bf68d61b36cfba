#include "corrector/tide/tide_choice.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/tide/permanent_tide.hpp"
#include "corrector/tide/tide_check.hpp"
#include "corrector/tide/tide_series.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::tide {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> kNames{"given", "direct", "catalogue", "longman", "none"};

/// Returns the tide at the site of a row; absent if it comes from a series without this time.
std::optional<MilliGal> chosen_tide(const reading::SurveyRow& row, UtcTime time,
                                    const std::vector<text::Site>& sites, const Choice& choice,
                                    const std::optional<Series>& series) {
    if (series) return series->at(time);
    if (choice.source == "given") {
        if (row.given_tide) return row.given_tide;
        throw InputError(
            fmt::format("tide = given: {} has no earth_tide_mgal; allowed: direct, catalogue, "
                        "longman, none, or a CSV time,tide_mgal",
                        row.site));
    }
    const Model model = tide_model(choice.source);
    const text::Site& site = text::required_site(sites, row.site);
    return earth_tide(model, time, {site.latitude, site.longitude, site.altitude}, choice.factors,
                      choice.system);
}

std::string_view model_text(const Choice& choice) {
    if (!choice.series.empty()) return "series of the file, cubic between its rows";
    if (choice.source == "given") return "column earth_tide_mgal";
    const Model model = tide_model(choice.source);
    if (model == Model::direct)
        return "positions of Moon and Sun, degrees 2 and 3, along the ellipsoid's normal";
    return model == Model::longman ? "Longman 1959, along the geocentric radius" : "none";
}

/// Returns what a result contains of the constant part of the tide, which not all programs remove.
std::string_view permanent_tide_text(const Choice& choice) {
    if (!choice.given_system && (!choice.series.empty() || choice.source == "given"))
        return "as in the given tide";
    if (choice.source == "none" || choice.system == System::mean) return "not removed";
    if (choice.system == System::zero) return "attraction removed, deformation kept";
    return choice.given_system ? "removed" : "removed, with the factor delta2";
}

System required_system(const std::string& text, const std::string& origin) {
    if (const auto system = system_named(text)) return *system;
    throw InputError(fmt::format("{} = {}: unknown; allowed: {}", origin, text, kTideSystems));
}

bool is_computed(const Choice& choice) {
    return choice.series.empty() && choice.source != "given" && choice.source != "none";
}

}  // namespace

bool set_tide_source(Choice& choice, const std::string& text,
                     const std::filesystem::path& directory) {
    const bool is_name = std::ranges::find(kNames, text) != kNames.end();
    const std::filesystem::path file = is_name ? std::filesystem::path() : directory / text;
    if (!is_name && !std::filesystem::is_regular_file(file)) return false;
    choice.series = file;
    choice.source = is_name ? text : file.filename().string();
    return true;
}

void set_tide_option(Choice& choice, const std::string& text) {
    if (set_tide_source(choice, text, "")) return;
    throw InputError(
        fmt::format("--tide = {}: neither a source nor a file; allowed: {}", text, kTideSources));
}

void take_given_system(Choice& choice, const std::vector<reading::SurveyRow>& rows,
                       const std::string& origin) {
    choice.given_system.reset();
    if (choice.source != "given" || rows.empty()) return;
    const std::string& first = rows.front().given_tide_system;
    for (const reading::SurveyRow& row : rows)
        if (row.given_tide_system != first)
            throw InputError(fmt::format(
                "{}: tide_system = '{}' of {} ({}), but '{}' in the first row; allowed: one system",
                origin, row.given_tide_system, row.site, row.occupation, first));
    if (first.empty()) return;
    choice.given_system = required_system(rows.front().given_tide_system, origin + ": tide_system");
    choice.system = *choice.given_system;
}

void set_tide_system(Choice& choice, const std::string& text, const std::string& origin) {
    const System system = required_system(text, origin);
    if (choice.given_system && system != *choice.given_system)
        throw InputError(
            fmt::format("{} = {}: the given tide has the tide_system {}; allowed: "
                        "that one, or the tide direct or longman",
                        origin, text, name_of(*choice.given_system)));
    if (system != System::tide_free && !is_computed(choice) && !choice.given_system)
        throw InputError(fmt::format(
            "{} = {}: the tide is {}, and what it contains of the permanent tide is not known; "
            "allowed: with the tide direct or longman",
            origin, text, choice.source));
    choice.system = system;
}

Model tide_model(const std::string& source) {
    // Both names use one model: it is within 0.0001 mGal of the harmonic catalogue (methods.md).
    if (source == "direct" || source == "catalogue") return Model::direct;
    if (source == "longman") return Model::longman;
    if (source == "none") return Model::none;
    throw InputError(fmt::format("tide = {}: unknown; allowed: {}", source, kTideSources));
}

void apply_tide(std::vector<reading::SurveyRow>& rows, const std::vector<text::Site>& sites,
                const Choice& choice, reading::DayRecord* day) {
    std::optional<Series> series;
    if (!choice.series.empty()) series = Series::read(choice.series);
    for (reading::SurveyRow& row : rows) {
        const auto tide = chosen_tide(row, row.time, sites, choice, series);
        if (!tide)
            throw InputError(fmt::format(
                "{}: time = {}, site {}: outside the series, or in one of its gaps; "
                "allowed: {} to {} in steps of at most {} s",
                choice.series.string(), to_rfc3339(row.time), row.site, to_rfc3339(series->first()),
                to_rfc3339(series->last()), kLongestTideStep.count()));
        row.tide = *tide;
    }
    if (day == nullptr) return;
    for (reading::DayBin& bin : day->bins) {
        const reading::SurveyRow& row = rows[bin.set_up];
        bin.tide = chosen_tide(row, bin.time, sites, choice, series).value_or(row.tide);
    }
}

std::vector<text::Message> tide_warnings(const std::vector<reading::SurveyRow>& rows,
                                         const std::vector<text::Site>& sites,
                                         const Choice& choice) {
    if (is_computed(choice)) return {};
    std::vector<text::Message> warnings;
    if (choice.factors != Factors{})
        warnings.push_back(
            text::message("the tide is {}: delta2 and delta3 have an effect only on a computed one",
                          choice.source));
    if (choice.source == "none") return warnings;
    std::vector<UsedTide> tides;
    std::vector<const reading::SurveyRow*> row_of;
    for (const reading::SurveyRow& row : rows) {
        const text::Site* const site = text::find_site(sites, row.site);
        if (site == nullptr || !site->is_placed) continue;
        tides.push_back(
            {row.time, {site->latitude, site->longitude, site->altitude}, row.tide.value()});
        row_of.push_back(&row);
    }
    const auto doubt = find_doubt(tides, kTideOfAnyTable, usual_tide);
    if (!doubt) return warnings;
    if (doubt->is_zero) {
        warnings.push_back(text::message(
            "the tide {} is 0 throughout, where the computed one varies by more than {:.2f} mGal. "
            "This is right only if the readings are corrected already; if not, use the tide direct",
            choice.source, kTideOfAnyTable.most_mgal));
        return warnings;
    }
    warnings.push_back(text::message(
        "the tide {} is not that of these times and places: it differs from the computed one by up "
        "to {:.3f} mGal, at {} ({}){}. It is used as it is",
        choice.source, doubt->size_mgal, row_of[doubt->index]->site,
        row_of[doubt->index]->occupation,
        doubt->remedy.empty() ? text::message(": check its sign, the times and the positions")
                              : doubt->remedy));
    return warnings;
}

void describe_tide(Json& settings, const Choice& choice) {
    settings["tide"] = choice.source;
    settings["tide_model"] = model_text(choice);
    settings["tide_sign"] = "effect on gravity: positive where gravity is larger; subtracted";
    settings["tide_system"] =
        is_computed(choice) || choice.given_system ? name_of(choice.system) : "as given";
    settings["permanent_tide"] = permanent_tide_text(choice);
    const bool has_factors = is_computed(choice);
    settings["delta2"] = has_factors ? Json(choice.factors.delta2) : Json(nullptr);
    settings["delta3"] = has_factors ? Json(choice.factors.delta3) : Json(nullptr);
}

}  // namespace a351::corrector::tide
