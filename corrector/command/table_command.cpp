#include "corrector/command/table_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "corrector/command/figures_option.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/report/report.hpp"
#include "corrector/result/export_files.hpp"
#include "corrector/result/result_files.hpp"
#include "corrector/result/table_text.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {
namespace {

struct TableOptions {
    std::string sites;
    std::string observations;
    SurveyOptions survey;
    std::string flags = "use";
    std::string tide;  ///< Empty: given where the column exists, else direct.
    TideFactors factors;
    std::vector<std::tuple<std::string, double, double>> priors;
    std::string out = "result";
    std::vector<std::string> figures;
};

void correct_table(TableOptions options) {
    require_folder_option("--out", options.out);
    const std::vector<text::Site> sites = text::read_sites(options.sites);
    std::vector<SurveyRow> rows = read_observations(options.observations, sites);
    if (options.tide.empty()) options.tide = rows.front().given_tide ? "given" : "direct";
    TideChoice tide;
    set_tide_option(tide, options.tide);
    tide.factors = {
        number_option("--delta2", options.factors.delta2, kLeastFactor, kGreatestFactor),
        number_option("--delta3", options.factors.delta3, kLeastFactor, kGreatestFactor)};
    apply_tide(rows, sites, tide);
    options.survey.use_flags = options.flags == "use";
    for (const auto& [name, mean, sd] : options.priors) {
        set_prior(options.survey.priors, "--prior", name, {mean, sd});
    }
    number_option("--datum-sd", options.survey.network.datum_sd_mgal, kLeastSd_mgal,
                  kGreatestSd_mgal);
    number_option("--reading-sd", options.survey.priors.reading_sd_mgal, kLeastSd_mgal,
                  kGreatestSd_mgal);
    const SurveyCorrection result = correct_survey(rows, options.survey);

    nlohmann::ordered_json settings;
    settings["command"] = "table";
    settings["model"] = options.survey.model;
    settings["flags"] = options.flags;
    describe_tide(settings, tide);
    settings["base"] = result.options.base;
    settings["datum"] = options.survey.datum;
    settings["rate"] = "backward";
    std::vector<std::string> warnings = position_warnings(rows, sites);
    settings["warnings"] = warnings;
    settings["seed"] = options.survey.seed;
    std::vector<text::InputFile> inputs{text::describe_input("sites", options.sites),
                                        text::describe_input("observations", options.observations)};
    if (!tide.series.empty()) inputs.push_back(text::describe_input("tide", tide.series));
    std::vector<text::NamedText> files = result_files(result, settings, inputs);
    for (text::NamedText& file : export_files(result, sites)) files.push_back(std::move(file));
    std::vector<std::string> told = warnings;
    told.insert(told.end(), result.remarks.begin(), result.remarks.end());
    Report report = make_report(result, settings,
                                {std::filesystem::path(options.observations).stem().string(),
                                 sites,
                                 {},
                                 {},
                                 inputs,
                                 told,
                                 options.figures});
    std::move(report.files.begin(), report.files.end(), std::back_inserter(files));
    text::write_together(options.out, files);
    warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
    for (const std::string& warning : warnings) std::cerr << "a351-correct: " << warning << '\n';
    std::cout << survey_text(result) << "written to " << options.out << '\n';
}

}  // namespace

void add_table_command(CLI::App& program) {
    CLI::App& command =
        *program.add_subcommand("table", "Corrects a survey given as one average per occupation.");
    const auto options = std::make_shared<TableOptions>();
    command.add_option("--sites", options->sites, "CSV of the benchmarks")->required();
    command
        .add_option("--observations", options->observations,
                    "CSV site,occupation[,outlier],time_utc|time_jst|time[,earth_tide_mgal],"
                    "acceleration_mgal,temperature_degc")
        ->required();
    command.add_option("--model", options->survey.model, "Model of the instrument")
        ->check(CLI::IsMember(model_names()))
        ->capture_default_str();
    command
        .add_option("--flags", options->flags,
                    "use: rows with outlier 1 stay out of the fit; ignore: they take part")
        ->check(CLI::IsMember({"use", "ignore"}))
        ->capture_default_str();
    command.add_option("--tide", options->tide,
                       "Tide as its effect on gravity, subtracted from the readings: " +
                           std::string(kTideSources) +
                           " (default: given where the column exists, else direct)");
    command.add_option("--delta2", options->factors.delta2, "Gravimetric factor of degree 2")
        ->capture_default_str();
    command.add_option("--delta3", options->factors.delta3, "Gravimetric factor of degree 3")
        ->capture_default_str();
    command.add_option("--base", options->survey.base,
                       "Station of the drift step (default: that of the first row)");
    command.add_option("--datum", options->survey.datum,
                       "Stations whose reference is held (default: all that have one)");
    command.add_option("--prior", options->priors,
                       "NAME MEAN SD: a coefficient known beforehand, by its name in result.json");
    command
        .add_option("--datum-sd", options->survey.network.datum_sd_mgal,
                    "network: standard deviation of a held reference, mGal")
        ->capture_default_str();
    command
        .add_option("--reading-sd", options->survey.priors.reading_sd_mgal,
                    "Standard deviation of a reading, mGal: its weight against priors and datum")
        ->capture_default_str();
    command
        .add_option("--drift-degree", options->survey.network.drift_degree,
                    "network: drift as a polynomial of this degree in time, 0 to 2")
        ->check(CLI::Range(0, 2))
        ->capture_default_str();
    std::vector<std::string> linear_models;
    linear_models.reserve(kLinearModels.size());
    for (const LinearModel& model : kLinearModels) linear_models.emplace_back(model.name);
    command.add_option("--robust-terms", options->survey.robust_terms, "robust: of which model")
        ->check(CLI::IsMember(linear_models))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder of the result")->capture_default_str();
    add_figures_option(command, options->figures);
    command.callback([options] { correct_table(*options); });
}

}  // namespace a351::corrector
