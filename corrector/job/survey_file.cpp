#include "corrector/job/survey_file.hpp"

#include <fmt/core.h>

#include <limits>

#include "corrector/model/model.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reduction/plate_and_pressure.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/plain_text.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::job {
namespace {

std::filesystem::path path_or(text::TomlTable& table, std::string_view key,
                              const std::filesystem::path& fallback) {
    const std::filesystem::path path = table.path_or_empty(key);
    return path.empty() ? fallback : path;
}

ReferenceSurvey read_reference(text::TomlTable table) {
    ReferenceSurvey reference;
    reference.observations = table.path_or_empty("observations");
    if (!std::filesystem::is_regular_file(reference.observations))
        table.refuse("observations", "no such file: " + reference.observations.string(),
                     "a table as a351-correct import writes it");
    reference.priors.reading_sd_mgal =
        table.number_or("reading_sd_mgal", adjustment::kGravimeterReadingSd_mgal,
                        adjustment::kLeastSd_mgal, adjustment::kGreatestSd_mgal);
    reference.network.drift_degree = static_cast<int>(table.integer_or(
        "drift_degree", reference.network.drift_degree, 0, model::kGreatestDriftDegree));
    const std::vector<double> scale = table.numbers("scale", -1.0, 2.0);
    if (table.has("scale")) {
        if (scale.size() != 2)
            table.refuse("scale", fmt::format("{} numbers", scale.size()), "[mean, sd]");
        adjustment::set_prior(reference.priors, "reference.scale", adjustment::kScale,
                              {scale[0], scale[1]});
    }
    table.require_all_read();
    return reference;
}

/// Reads the channel of a barometer in the archive of the root.
void read_pressure_channel(SurveyFile& survey, text::TomlTable& table) {
    constexpr double kLeastCounts = 1e-3, kMostCounts = 1e9;
    const std::string name = table.string_or("pressure_channel", "");
    const double counts_per_hpa = table.number_or(
        "pressure_counts_per_hpa", reduction::kCountsPerHpa, kLeastCounts, kMostCounts);
    if (name.empty()) return;
    survey.reduction.pressure_channel = reduction::pressure_channel(name);
    if (!survey.reduction.pressure_channel)
        table.refuse("pressure_channel", "not a channel of pressure", "NET.STA.LOC.?D?");
    if (!survey.reduction.pressure.empty())
        table.refuse("pressure_channel", "there is a file of the pressure too", "one of them");
    survey.reduction.pressure_channel->archive = survey.root / "archive";
    survey.reduction.pressure_channel->counts_per_hpa = counts_per_hpa;
}

/// Refuses keys that earlier versions had, and says what replaced them.
void refuse_removed_keys(const text::TomlTable& table) {
    if (table.has("curve"))
        table.refuse("curve", "unknown key",
                     "no such key, because the curve follows from the model: that of the "
                     "publication for paper, the slow one for all others");
    if (table.has("robust_terms"))
        table.refuse("robust_terms", "unknown key",
                     "no such key, because every model but paper is searched for bad readings");
}

void read_tide(SurveyFile& survey, text::TomlTable& table) {
    if (!tide::set_tide_source(survey.tide, table.string_or("tide", "direct"),
                               survey.path.parent_path()))
        table.refuse("tide", "neither a source nor a file", tide::kTideSources);
    survey.tide.factors.delta2 = table.number_or("delta2", survey.tide.factors.delta2,
                                                 tide::kLeastFactor, tide::kGreatestFactor);
    survey.tide.factors.delta3 = table.number_or("delta3", survey.tide.factors.delta3,
                                                 tide::kLeastFactor, tide::kGreatestFactor);
    tide::set_tide_system(
        survey.tide, table.choice_or("tide_system", "tide-free", {"tide-free", "zero", "mean"}),
        survey.path.string() + ": survey.tide_system");
}

void read_reduction(SurveyFile& survey, text::TomlTable& table) {
    if (const auto height =
            table.number("instrument_height_m", -reading::kGreatestInstrumentHeight_m,
                         reading::kGreatestInstrumentHeight_m))
        survey.reduction.height = Metres(*height);
    survey.reduction.pressure = table.path_or_empty("pressure");
    read_pressure_channel(survey, table);
    survey.reduction.admittance_mgal_per_hpa = table.number_or(
        "admittance_mgal_per_hpa", survey.reduction.admittance_mgal_per_hpa,
        reduction::kLeastAdmittance_mgal_per_hpa, reduction::kGreatestAdmittance_mgal_per_hpa);
    survey.reduction.is_admittance_fitted = survey.survey.network.fits_admittance =
        table.boolean_or("fit_admittance", false);
    survey.bouguer_density_kg_per_m3 =
        table.number("bouguer_density_kg_per_m3", reduction::kLeastDensity_kg_per_m3,
                     reduction::kGreatestDensity_kg_per_m3);
}

void read_averaging(SurveyFile& survey, text::TomlTable& table) {
    survey.averaging.trend = table.choice_or("trend", "eemd", {"eemd", "smoother"}) == "eemd"
                                 ? reading::TrendMethod::eemd
                                 : reading::TrendMethod::smoother;
    survey.averaging.cutoff_s =
        table.number_or("cutoff_s", survey.averaging.cutoff_s, reading::kShortestCutoff_s,
                        reading::kLongestCutoff_s);
    survey.averaging.norm = table.choice_or("norm", "decimate-first",
                                            {"decimate-first", "as-published"}) == "decimate-first"
                                ? reading::NormOrder::decimate_first
                                : reading::NormOrder::as_published;
}

void read_calibration_of_unit(SurveyFile& survey, text::TomlTable& table) {
    const auto calibration = table.path_or_empty("calibration");
    if (calibration.empty()) return;
    if (!std::filesystem::exists(calibration))
        table.refuse("calibration", "no such file: " + calibration.string(),
                     "a file of a351-correct calibrate, or empty");
    use_calibration(survey, calibration);
}

void read_network(SurveyFile& survey, text::TomlTable& table) {
    survey.survey.priors.reading_sd_mgal =
        table.number_or("reading_sd_mgal", survey.survey.priors.reading_sd_mgal,
                        adjustment::kLeastSd_mgal, adjustment::kGreatestSd_mgal);
    survey.survey.network.datum_sd_mgal =
        table.number_or("datum_sd_mgal", survey.survey.network.datum_sd_mgal,
                        adjustment::kLeastSd_mgal, adjustment::kGreatestSd_mgal);
    survey.survey.network.drift_degree = static_cast<int>(table.integer_or(
        "drift_degree", survey.survey.network.drift_degree, 0, model::kGreatestDriftDegree));
}

}  // namespace

SurveyFile read_survey_file(const std::filesystem::path& file) {
    text::TomlTable document = text::read_toml(file);
    text::TomlTable table = document.table("survey");
    const std::filesystem::path beside = file.parent_path();

    SurveyFile survey;
    survey.path = file;
    survey.name = table.string_or("name", file.stem().string());
    if (survey.name.empty()) table.refuse("name", "empty", "a name");
    survey.root = path_or(table, "root", beside / "data");
    survey.sites = path_or(table, "sites", beside / "sites.csv");
    survey.occupations = table.path_or_empty("occupations");
    survey.from = table.instant("from_utc");
    survey.to = table.instant("to_utc");
    survey.amendments = table.path_or_empty("amendments");
    survey.survey.base = text::plain_text(table.string_or("base", ""));
    survey.survey.datum = table.strings("datum");
    for (std::string& name : survey.survey.datum) name = text::plain_text(name);
    survey.survey.model = table.choice_or("model", "auto", model::model_names());
    survey.survey.use_flags = table.choice_or("flags", "use", {"use", "ignore"}) == "use";
    read_tide(survey, table);
    read_reduction(survey, table);
    read_averaging(survey, table);
    survey.survey.seed = static_cast<std::uint64_t>(
        table.integer_or("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
    read_calibration_of_unit(survey, table);
    read_network(survey, table);
    refuse_removed_keys(table);
    table.require_all_read();
    adjustment::read_priors(survey.survey.priors, document.table("prior"));
    if (document.has("reference")) survey.reference = read_reference(document.table("reference"));
    document.require_all_read();

    if (!std::filesystem::is_directory(survey.root))
        table.refuse("root", "no such directory: " + survey.root.string(), "a data root");
    const std::vector<text::Site> sites = text::read_sites(survey.sites);
    if (!survey.survey.base.empty())
        reading::require_site(table, "base", sites, survey.survey.base);
    for (const std::string& name : survey.survey.datum)
        reading::require_site(table, "datum", sites, name);
    return survey;
}

SurveyFile survey_of_root(const std::filesystem::path& root, const std::filesystem::path& sites) {
    SurveyFile survey;
    survey.root = std::filesystem::canonical(root);
    survey.name = survey.root.filename().string();
    survey.sites = sites.empty() ? survey.root.parent_path() / "sites.csv" : sites;
    static_cast<void>(text::read_sites(survey.sites));
    return survey;
}

void use_calibration(SurveyFile& survey, const std::filesystem::path& file) {
    survey.calibration = file;
    survey.survey.calibration = unit::read_calibration(file);
}

void describe_correction(nlohmann::ordered_json& settings, const SurveyFile& survey,
                         const std::string& base) {
    settings["model"] = survey.survey.model;
    settings["flags"] = survey.survey.use_flags ? "use" : "ignore";
    tide::describe_tide(settings, survey.tide);
    reduction::describe_reduction(settings, survey.reduction);
    settings["bouguer_density_kg_per_m3"] = text::or_null(survey.bouguer_density_kg_per_m3);
    settings["base"] = base;
    settings["datum"] = survey.survey.datum;
}

reading::RepresentativeOptions averaging_of(const SurveyFile& survey) {
    reading::RepresentativeOptions averaging = survey.averaging;
    averaging.seed = survey.survey.seed;
    if (survey.survey.model != model::kPaper) return averaging;
    averaging.trend = reading::TrendMethod::eemd;
    averaging.curve = reading::TrendCurve::paper;
    return averaging;
}

}  // namespace a351::corrector::job
