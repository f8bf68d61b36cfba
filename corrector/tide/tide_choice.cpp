#include "corrector/tide/tide_choice.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "corrector/tide/tide_series.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector {
namespace {

constexpr std::array<std::string_view, 5> kNames{"given", "direct", "catalogue", "longman", "none"};

void set_series_tide(std::vector<SurveyRow>& rows, const std::filesystem::path& file) {
    const TideSeries series = TideSeries::read(file);
    for (SurveyRow& row : rows) {
        const auto tide = series.at(row.time);
        if (!tide) {
            throw InputError(file.string() + ": time = " + to_rfc3339(row.time) + ", site " +
                             row.site + ": outside the series, or in one of its gaps; allowed: " +
                             to_rfc3339(series.first()) + " to " + to_rfc3339(series.last()) +
                             " in steps of at most " + std::to_string(kLongestTideStep.count()) +
                             " s");
        }
        row.tide = *tide;
    }
}

bool is_computed(const TideChoice& choice) {
    return choice.series.empty() && choice.source != "given" && choice.source != "none";
}

std::string_view model_text(const TideChoice& choice) {
    if (!choice.series.empty()) return "series of the file, cubic between its rows";
    if (choice.source == "given") return "column earth_tide_mgal";
    switch (tide_model(choice.source)) {
        case TideModel::none:
            break;
        case TideModel::direct:
            return "positions of Moon and Sun, degrees 2 and 3, along the ellipsoid's normal";
        case TideModel::longman:
            return "Longman 1959, along the geocentric radius";
    }
    return "none";
}

}  // namespace

bool set_tide_source(TideChoice& choice, const std::string& text,
                     const std::filesystem::path& directory) {
    const bool is_name = std::find(kNames.begin(), kNames.end(), text) != kNames.end();
    const std::filesystem::path file = is_name ? std::filesystem::path() : directory / text;
    if (!is_name && !std::filesystem::is_regular_file(file)) return false;
    choice.series = file;
    choice.source = is_name ? text : file.filename().string();
    return true;
}

void set_tide_option(TideChoice& choice, const std::string& text) {
    if (set_tide_source(choice, text, "")) return;
    throw InputError("--tide = " + text +
                     ": neither a source nor a file; allowed: " + std::string(kTideSources));
}

TideModel tide_model(const std::string& source) {
    // One model for both names: direct is within 0.0001 mGal of the full harmonic catalogue.
    if (source == "direct" || source == "catalogue") return TideModel::direct;
    if (source == "longman") return TideModel::longman;
    if (source == "none") return TideModel::none;
    throw InputError("tide = " + source + ": unknown; allowed: " + std::string(kTideSources));
}

void set_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites, TideModel model,
              TideFactors factors) {
    for (SurveyRow& row : rows) {
        const text::Site* const site = text::find_site(sites, row.site);
        if (site == nullptr) {
            throw InputError("site " + row.site +
                             ": unknown; allowed: a name of the table of sites");
        }
        row.tide =
            earth_tide(model, row.time, {site->latitude, site->longitude, site->altitude}, factors);
    }
}

void set_given_tide(std::vector<SurveyRow>& rows) {
    for (SurveyRow& row : rows) {
        if (!row.given_tide) {
            throw InputError("tide = given: " + row.site +
                             " has no earth_tide_mgal; allowed: direct, catalogue, longman, none, "
                             "or a CSV time,tide_mgal");
        }
        row.tide = *row.given_tide;
    }
}

void apply_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites,
                const TideChoice& choice) {
    if (!choice.series.empty()) {
        set_series_tide(rows, choice.series);
    } else if (choice.source == "given") {
        set_given_tide(rows);
    } else {
        set_tide(rows, sites, tide_model(choice.source), choice.factors);
    }
}

void describe_tide(nlohmann::ordered_json& settings, const TideChoice& choice) {
    settings["tide"] = choice.source;
    settings["tide_model"] = model_text(choice);
    settings["tide_sign"] = "effect on gravity: positive where gravity is larger; subtracted";
    settings["delta2"] = nullptr;
    settings["delta3"] = nullptr;
    if (!is_computed(choice)) return;
    settings["delta2"] = choice.factors.delta2;
    settings["delta3"] = choice.factors.delta3;
}

}  // namespace a351::corrector
