#include "corrector/tide/tide_choice.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "corrector/tide/tide_series.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::tide {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> kNames{"given", "direct", "catalogue", "longman", "none"};

/// The chosen tide at any instant.
class ChosenTide {
public:
    ChosenTide(const std::vector<text::Site>& sites, const Choice& choice)
        : sites_(sites), choice_(choice) {
        if (!choice.series.empty()) series_ = Series::read(choice.series);
    }

    /// Returns the tide at the site of a row.
    [[nodiscard]] MilliGal at(const reading::SurveyRow& row, UtcTime time) const {
        if (series_) return of_series(row, time);
        if (choice_.source == "given") return given(row);
        const Model model = tide_model(choice_.source);
        const text::Site* const site = text::find_site(sites_, row.site);
        if (site == nullptr)
            throw InputError(
                fmt::format("site {}: unknown; allowed: a name of the table of sites", row.site));
        return earth_tide(model, time, {site->latitude, site->longitude, site->altitude},
                          choice_.factors);
    }

    /// Returns false if the tide comes from a series that does not have this time.
    [[nodiscard]] bool covers(UtcTime time) const { return !series_ || series_->at(time); }

private:
    [[nodiscard]] MilliGal of_series(const reading::SurveyRow& row, UtcTime time) const {
        if (const auto tide = series_->at(time)) return *tide;
        throw InputError(fmt::format(
            "{}: time = {}, site {}: outside the series, or in one of its gaps; "
            "allowed: {} to {} in steps of at most {} s",
            choice_.series.string(), to_rfc3339(time), row.site, to_rfc3339(series_->first()),
            to_rfc3339(series_->last()), kLongestTideStep.count()));
    }

    static MilliGal given(const reading::SurveyRow& row) {
        if (row.given_tide) return *row.given_tide;
        throw InputError(
            fmt::format("tide = given: {} has no earth_tide_mgal; allowed: direct, catalogue, "
                        "longman, none, or a CSV time,tide_mgal",
                        row.site));
    }

    const std::vector<text::Site>& sites_;
    const Choice& choice_;
    std::optional<Series> series_;
};

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
    if (!choice.series.empty() || choice.source == "given") return "as in the given tide";
    return choice.source == "none" ? "not removed" : "removed, with the factor delta2";
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

Model tide_model(const std::string& source) {
    // Both names use one model: it is within 0.0001 mGal of the harmonic catalogue (methods.md).
    if (source == "direct" || source == "catalogue") return Model::direct;
    if (source == "longman") return Model::longman;
    if (source == "none") return Model::none;
    throw InputError(fmt::format("tide = {}: unknown; allowed: {}", source, kTideSources));
}

void apply_tide(std::vector<reading::SurveyRow>& rows, const std::vector<text::Site>& sites,
                const Choice& choice, reading::DayRecord* day) {
    const ChosenTide tide(sites, choice);
    for (reading::SurveyRow& row : rows) row.tide = tide.at(row, row.time);
    if (day == nullptr) return;
    for (reading::DayBin& bin : day->bins) {
        const reading::SurveyRow& row = rows[bin.set_up];
        bin.tide = tide.covers(bin.time) ? tide.at(row, bin.time) : row.tide;
    }
}

void describe_tide(Json& settings, const Choice& choice) {
    settings["tide"] = choice.source;
    settings["tide_model"] = model_text(choice);
    settings["tide_sign"] = "effect on gravity: positive where gravity is larger; subtracted";
    settings["permanent_tide"] = permanent_tide_text(choice);
    const bool is_computed =
        choice.series.empty() && choice.source != "given" && choice.source != "none";
    settings["delta2"] = is_computed ? Json(choice.factors.delta2) : Json(nullptr);
    settings["delta3"] = is_computed ? Json(choice.factors.delta3) : Json(nullptr);
}

}  // namespace a351::corrector::tide
