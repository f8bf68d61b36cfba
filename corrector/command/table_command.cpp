#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/command/progress_bar.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reduction/normal_gravity.hpp"
#include "corrector/reduction/row_reduction.hpp"
#include "corrector/report/report.hpp"
#include "corrector/result/anomalies.hpp"
#include "corrector/result/result_files.hpp"
#include "corrector/result/table_text.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

struct TableOptions {
    std::string sites;
    std::string observations;
    model::SurveyOptions survey;
    std::string flags = "use";
    std::string tide;  ///< Empty: given if the column exists, else direct.
    tide::Factors factors;
    std::string pressure;
    double admittance_mgal_per_hpa = reduction::kAdmittance_mgal_per_hpa;
    std::optional<double> bouguer_density_kg_per_m3;
    std::vector<std::tuple<std::string, double, double>> priors;
    std::string out = "result";
    std::vector<std::string> figures;
};

void correct_table(TableOptions options) {
    require_folder_option("--out", options.out);
    const std::vector<text::Site> sites = text::read_sites(options.sites);
    std::vector<reading::SurveyRow> rows = reading::read_observations(options.observations, sites);
    if (options.tide.empty()) options.tide = rows.front().given_tide ? "given" : "direct";
    tide::Choice tide;
    tide::set_tide_option(tide, options.tide);
    tide.factors = tide_factor_options(options.factors);
    tide::apply_tide(rows, sites, tide);
    const reduction::ReductionChoice reduction{
        .height = {},
        .pressure = options.pressure,
        .admittance_mgal_per_hpa = number_option("--admittance", options.admittance_mgal_per_hpa,
                                                 reduction::kLeastAdmittance_mgal_per_hpa,
                                                 reduction::kGreatestAdmittance_mgal_per_hpa),
        .is_admittance_fitted = options.survey.network.fits_admittance};
    const std::vector<text::Message> reduced =
        reduction::reduce_rows(rows, sites, reduction::read_gradients(options.sites), reduction);
    const std::optional<double> density = options.bouguer_density_kg_per_m3;
    if (density)
        number_option("--bouguer-density", *density, reduction::kLeastDensity_kg_per_m3,
                      reduction::kGreatestDensity_kg_per_m3);
    options.survey.use_flags = options.flags == "use";
    for (const auto& [name, mean, sd] : options.priors) {
        adjustment::set_prior(options.survey.priors, "--prior", name, {mean, sd});
    }
    number_option("--datum-sd", options.survey.network.datum_sd_mgal, adjustment::kLeastSd_mgal,
                  adjustment::kGreatestSd_mgal);
    number_option("--reading-sd", options.survey.priors.reading_sd_mgal, adjustment::kLeastSd_mgal,
                  adjustment::kGreatestSd_mgal);
    model::SurveyCorrection result = [&] {
        ProgressBar bar("search for mistakes");
        return judgement::correct_and_search({rows, sites, nullptr, std::ref(bar)}, options.survey);
    }();
    if (density) result::add_anomalies(result.stations, sites, *density);

    nlohmann::ordered_json settings;
    settings["command"] = "table";
    settings["model"] = options.survey.model;
    settings["flags"] = options.flags;
    tide::describe_tide(settings, tide);
    reduction::describe_reduction(settings, reduction);
    settings["bouguer_density_kg_per_m3"] = text::or_null(density);
    settings["base"] = result.options.base;
    settings["datum"] = options.survey.datum;
    settings["rate"] = "backward";
    std::vector<text::Message> warnings = reading::position_warnings(rows, sites);
    warnings.insert(warnings.end(), reduced.begin(), reduced.end());
    settings["warnings"] = text::in_english(warnings);
    settings["seed"] = options.survey.seed;
    std::vector<text::InputFile> inputs{text::describe_input("sites", options.sites),
                                        text::describe_input("observations", options.observations)};
    if (!tide.series.empty()) inputs.push_back(text::describe_input("tide", tide.series));
    if (!options.pressure.empty())
        inputs.push_back(text::describe_input("pressure", options.pressure));
    std::vector<text::NamedText> files = result::result_files(result, settings, inputs, sites);
    report::Report report =
        report::make_report(result, settings,
                            {std::filesystem::path(options.observations).stem().string(),
                             sites,
                             {},
                             {},
                             {},
                             inputs,
                             warnings,
                             options.figures});
    std::move(report.files.begin(), report.files.end(), std::back_inserter(files));
    text::write_together(options.out, files);
    warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
    for (const text::Message& warning : warnings)
        std::cerr << "a351-correct: " << text::in_words(warning) << '\n';
    std::cout << reading::findings_text(result.findings) << result::survey_text(result)
              << "written to " << options.out << '\n';
}

}  // namespace

void add_table_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "table", "Corrects a survey that is given as one average per occupation.");
    const auto options = std::make_shared<TableOptions>();
    add_required(command, "--sites", "CSV", options->sites, "Benchmarks");
    add_required(command, "--observations", "CSV", options->observations,
                 "Averages, with the columns site, occupation, time_utc (or time_jst, time), "
                 "acceleration_mgal, temperature_degc and, if known, outlier, earth_tide_mgal, "
                 "instrument_height_m and pressure_hpa");
    add_with_default(command, "--model", "NAME", options->survey.model, "Model of the instrument")
        ->check(CLI::IsMember(model::model_names()));
    add_with_default(command, "--flags", "RULE", options->flags,
                     "use: rows with outlier = 1 are not used in the fit; ignore: they are used")
        ->check(CLI::IsMember({"use", "ignore"}));
    add_option(command, "--tide", "SOURCE", options->tide,
               "Tide, as its effect on gravity, that is subtracted from the readings: " +
                   std::string(tide::kTideSources) +
                   " (default: given if the column exists, else direct)");
    add_tide_factors(command, options->factors);
    add_option(
        command, "--pressure", "CSV", options->pressure,
        "Air pressure at the stations, time,pressure_hpa, for readings without pressure_hpa");
    add_with_default(command, "--admittance", "MGAL/HPA", options->admittance_mgal_per_hpa,
                     "Effect of the air pressure on gravity");
    command.add_flag("--fit-admittance", options->survey.network.fits_admittance,
                     "network: fit the effect of the air pressure instead");
    add_option(command, "--bouguer-density", "KG/M3", options->bouguer_density_kg_per_m3,
               "Add normal gravity (GRS80), free-air anomaly and simple Bouguer anomaly of the "
               "stations, with a plate of this density (usual: 2670)");
    add_option(
        command, "--base", "SITE", options->survey.base,
        "Base station, for the drift of the model paper (default: station of the first row)");
    add_option(command, "--datum", "SITE", options->survey.datum,
               "Stations whose reference gravity is used (default: all that have one)");
    add_option(
        command, "--prior", "NAME MEAN SD", options->priors,
        "Coefficient known beforehand: its name in result.json, mean and standard deviation");
    add_with_default(command, "--datum-sd", "MGAL", options->survey.network.datum_sd_mgal,
                     "network: standard deviation of a reference that is held");
    add_with_default(command, "--reading-sd", "MGAL", options->survey.priors.reading_sd_mgal,
                     "Standard deviation of a reading: its weight against priors and datum");
    add_with_default(command, "--drift-degree", "N", options->survey.network.drift_degree,
                     "network: degree of the polynomial in time that describes the drift, 0-3")
        ->check(CLI::Range(0, model::kGreatestDriftDegree));
    add_with_default(command, "--out", "DIR", options->out, "Folder of the result");
    add_figures_option(command, options->figures);
    command.callback([options] { correct_table(*options); });
}

}  // namespace a351::corrector::command
