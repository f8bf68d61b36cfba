#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/job/survey_file.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/model/model.hpp"
#include "corrector/reduction/plate_and_pressure.hpp"
#include "corrector/report/report.hpp"
#include "corrector/result/anomalies.hpp"
#include "corrector/result/result_files.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/plain_text.hpp"
#include "protocol/text/progress_bar.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

struct TableOptions {
    job::SurveyFile survey;
    std::string observations;
    std::string flags = "use";
    std::string tide_system;
    std::string tide;  ///< Empty: given if the column exists, else direct.
    std::vector<std::tuple<std::string, double, double>> priors;
    std::optional<double> reading_sd_mgal;  ///< Absent: that of the instrument.
    std::string out = "result";
    figure::FigureOptions figures;
    bool is_verbose = false;
};

/// Checks the options of the correction, and sets those that are texts.
/// @param rows  of the table, whose columns decide which tide is the default.
void set_options(TableOptions& options, const std::vector<reading::SurveyRow>& rows) {
    job::SurveyFile& survey = options.survey;
    if (options.tide.empty()) options.tide = rows.front().given_tide ? "given" : "direct";
    tide::set_tide_option(survey.tide, options.tide);
    tide::take_given_system(survey.tide, rows, options.observations);
    survey.tide.factors = tide_factor_options(survey.tide.factors);
    survey.survey.base = text::plain_text(survey.survey.base);
    for (std::string& name : survey.survey.datum) name = text::plain_text(name);
    if (!options.tide_system.empty())
        tide::set_tide_system(survey.tide, options.tide_system, "--tide-system");
    number_option("--admittance", survey.reduction.admittance_mgal_per_hpa,
                  reduction::kLeastAdmittance_mgal_per_hpa,
                  reduction::kGreatestAdmittance_mgal_per_hpa);
    survey.reduction.is_admittance_fitted = survey.survey.network.fits_admittance;
    if (survey.bouguer_density_kg_per_m3)
        number_option("--bouguer-density", *survey.bouguer_density_kg_per_m3,
                      reduction::kLeastDensity_kg_per_m3, reduction::kGreatestDensity_kg_per_m3);
    survey.survey.use_flags = options.flags == "use";
    for (const auto& [name, mean, sd] : options.priors)
        adjustment::set_prior(survey.survey.priors, "--prior", name, {mean, sd});
    number_option("--datum-sd", survey.survey.network.datum_sd_mgal, adjustment::kLeastSd_mgal,
                  adjustment::kGreatestSd_mgal);
    double& reading_sd_mgal = survey.survey.priors.reading_sd_mgal;
    if (!rows.front().instrument.empty()) reading_sd_mgal = adjustment::kGravimeterReadingSd_mgal;
    reading_sd_mgal = options.reading_sd_mgal.value_or(reading_sd_mgal);
    number_option("--reading-sd", reading_sd_mgal, adjustment::kLeastSd_mgal,
                  adjustment::kGreatestSd_mgal);
}

void correct_table(TableOptions options) {
    require_folder_option("--out", options.out);
    const job::SurveyFile& survey = options.survey;
    const std::vector<text::Site> sites = text::read_sites(survey.sites);
    std::vector<reading::SurveyRow> rows = reading::read_observations(options.observations, sites);
    set_options(options, rows);
    tide::apply_tide(rows, sites, survey.tide);
    const std::vector<text::Message> reduced = reduction::reduce_rows(
        rows, sites, reduction::read_gradients(survey.sites), survey.reduction);
    model::SurveyCorrection result = [&] {
        text::ProgressBar bar("search for mistakes");
        return judgement::correct_and_search({rows, sites, nullptr, std::ref(bar)}, survey.survey);
    }();
    if (const auto density = survey.bouguer_density_kg_per_m3)
        result::add_anomalies(result.stations, sites, *density);

    report::ReportSources sources;
    sources.title = std::filesystem::path(options.observations).stem().string();
    sources.sites = sites;
    sources.inputs = {text::describe_input("sites", survey.sites),
                      text::describe_input("observations", options.observations)};
    for (const auto& [role, file] :
         {std::pair("tide", survey.tide.series), std::pair("pressure", survey.reduction.pressure)})
        if (!file.empty()) sources.inputs.push_back(text::describe_input(role, file));
    sources.warnings = reading::position_warnings(rows, sites);
    const std::vector<text::Message> far = reading::row_warnings(rows);
    sources.warnings.insert(sources.warnings.end(), far.begin(), far.end());
    for (text::Message& warning : tide::tide_warnings(rows, sites, survey.tide))
        sources.warnings.push_back(std::move(warning));
    sources.warnings.insert(sources.warnings.end(), reduced.begin(), reduced.end());
    sources.figures = options.figures;
    nlohmann::ordered_json settings;
    settings["command"] = "table";
    job::describe_correction(settings, survey, result.options.base);
    settings["rate"] = "backward";
    settings["warnings"] = text::in_english(sources.warnings);
    settings["seed"] = survey.survey.seed;
    std::vector<text::NamedText> files =
        result::result_files(result, settings, sources.inputs, sites);
    report::Report report = report::make_report(result, settings, sources);
    std::ranges::move(report.files, std::back_inserter(files));
    text::write_together(options.out, files);
    print_warnings(sources.warnings);
    print_warnings({report.warnings.begin(), report.warnings.end()});
    std::cout << result::survey_text(result, options.is_verbose) << "\nwritten to " << options.out
              << '\n';
}

}  // namespace

void add_table_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "table", "Corrects a survey that is given as one average per occupation.");
    const auto options = std::make_shared<TableOptions>();
    job::SurveyFile& survey = options->survey;
    model::SurveyOptions& correction = survey.survey;
    add_required(command, "--sites", "CSV", survey.sites, "Benchmarks");
    add_required(command, "--observations", "CSV", options->observations,
                 "Averages, with the columns site, occupation, time_utc (or time_jst, time), "
                 "acceleration_mgal, temperature_degc and, if known, outlier, earth_tide_mgal, "
                 "instrument_height_m and pressure_hpa");
    add_with_default(command, "--model", "NAME", correction.model, "Model of the instrument")
        ->check(CLI::IsMember(model::model_names()));
    add_with_default(command, "--flags", "RULE", options->flags,
                     "use: rows with outlier = 1 are not used in the fit; ignore: they are used")
        ->check(CLI::IsMember({"use", "ignore"}));
    add_option(command, "--tide", "SOURCE", options->tide,
               "Tide, as its effect on gravity, that is subtracted from the readings: " +
                   std::string(tide::kTideSources) +
                   " (default: given if the column exists, else direct)");
    add_tide_factors(command, survey.tide.factors);
    add_tide_system(command, options->tide_system);
    add_option(
        command, "--pressure", "CSV", survey.reduction.pressure,
        "Air pressure at the stations, time,pressure_hpa, for readings without pressure_hpa");
    add_with_default(command, "--admittance", "MGAL/HPA", survey.reduction.admittance_mgal_per_hpa,
                     "Effect of the air pressure on gravity");
    command.add_flag("--fit-admittance", correction.network.fits_admittance,
                     "network: fit the effect of the air pressure instead");
    add_option(command, "--bouguer-density", "KG/M3", survey.bouguer_density_kg_per_m3,
               "Add normal gravity (GRS80), free-air anomaly and simple Bouguer anomaly of the "
               "stations, with a plate of this density (usual: 2670)");
    add_option(
        command, "--base", "SITE", correction.base,
        "Base station, for the drift of the model paper (default: station of the first row)");
    add_option(command, "--datum", "SITE", correction.datum,
               "Stations whose reference gravity is used (default: all that have one)");
    add_option(
        command, "--prior", "NAME MEAN SD", options->priors,
        "Coefficient known beforehand: its name in result.json, mean and standard deviation");
    add_with_default(command, "--datum-sd", "MGAL", correction.network.datum_sd_mgal,
                     "network: standard deviation of a reference that is held");
    add_option(command, "--reading-sd", "MGAL", options->reading_sd_mgal,
               "Standard deviation of a reading: its weight against priors and datum "
               "(default: 2, or 0.01 for gravimeters: column instrument)");
    add_with_default(command, "--drift-degree", "N", correction.network.drift_degree,
                     "network: degree of the polynomial in time that describes the drift, 0-3")
        ->check(CLI::Range(0, model::kGreatestDriftDegree));
    add_with_default(command, "--out", "DIR", options->out, "Folder of the result");
    add_figure_options(command, options->figures);
    add_verbose_flag(command, options->is_verbose);
    command.callback([options] { correct_table(*options); });
}

}  // namespace a351::corrector::command
