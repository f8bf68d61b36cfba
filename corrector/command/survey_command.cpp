#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <tuple>

#include "corrector/command/commands.hpp"
#include "corrector/command/gravity_so_far.hpp"
#include "corrector/command/options.hpp"
#include "corrector/job/survey_day.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/job/survey_units.hpp"
#include "corrector/model/joint_adjustment.hpp"
#include "corrector/model/model.hpp"
#include "corrector/report/joint_page.hpp"
#include "corrector/report/report.hpp"
#include "corrector/result/anomalies.hpp"
#include "corrector/result/answer.hpp"
#include "corrector/result/columns.hpp"
#include "corrector/result/joint_report.hpp"
#include "corrector/result/joint_table.hpp"
#include "corrector/result/result_files.hpp"
#include "corrector/result/table_text.hpp"
#include "corrector/result/unit_history.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/progress_bar.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

/// Options of the command line; an empty text keeps the value of the survey file.
struct SurveyCommandOptions {
    std::vector<std::string> files;
    std::string out;
    std::string model;
    std::string flags;
    std::string tide, tide_system;
    std::string trend;
    std::string calibration;
    std::string from, to;
    figure::FigureOptions figures;
    std::string sites;
    bool is_json = false;
    bool is_verbose = false;
};

job::SurveyFile read_survey_of(const std::string& file, const std::string& sites) {
    // The unpacked folder of `a351ctl bundle` has its survey file.
    const std::filesystem::path in_folder = std::filesystem::path(file) / "survey.toml";
    if (sites.empty() && std::filesystem::exists(in_folder))
        return job::read_survey_file(in_folder);
    if (std::filesystem::is_directory(file)) return job::survey_of_root(file, sites);
    if (!sites.empty())
        throw InputError("--sites " + sites + ": " + file +
                         " is a survey file, which names its sites; allowed: with a data root");
    return job::read_survey_file(file);
}

job::SurveyFile with_overrides(job::SurveyFile survey, const SurveyCommandOptions& options) {
    if (!options.model.empty()) survey.survey.model = options.model;
    if (!options.flags.empty()) survey.survey.use_flags = options.flags == "use";
    if (!options.tide.empty()) tide::set_tide_option(survey.tide, options.tide);
    const std::string system(options.tide_system.empty() ? tide::name_of(survey.tide.system)
                                                         : options.tide_system);
    tide::set_tide_system(survey.tide, system, "--tide-system");
    if (!options.trend.empty())
        survey.averaging.trend =
            options.trend == "eemd" ? reading::TrendMethod::eemd : reading::TrendMethod::smoother;
    if (!options.calibration.empty()) job::use_calibration(survey, options.calibration);
    if (!options.from.empty()) survey.from = instant_option("--from", options.from);
    if (!options.to.empty()) survey.to = instant_option("--to", options.to);
    if (survey.from && survey.to && *survey.from >= *survey.to) {
        throw InputError(fmt::format("{}: to_utc = {}; allowed: an instant after from_utc = {}",
                                     survey.path.string(), to_rfc3339(*survey.to),
                                     to_rfc3339(*survey.from)));
    }
    return survey;
}

nlohmann::ordered_json settings_of(const job::SurveyFile& survey,
                                   const model::SurveyCorrection& result,
                                   const reading::OccupationRows& read) {
    nlohmann::ordered_json settings;
    settings["command"] = "survey";
    settings["name"] = survey.name;
    settings["serial_number"] = text::or_null(read.serial_number);
    job::describe_correction(settings, survey, result.options.base);
    const reading::RepresentativeOptions averaging = job::averaging_of(survey);
    settings["trend"] = averaging.trend == reading::TrendMethod::eemd ? "eemd" : "smoother";
    settings["cutoff_s"] = averaging.cutoff_s;
    settings["curve"] = averaging.curve == reading::TrendCurve::paper ? "paper" : "slow";
    settings["norm"] =
        averaging.norm == reading::NormOrder::decimate_first ? "decimate-first" : "as-published";
    settings["rate"] = "interval";
    settings["calibration"] = survey.calibration.filename().string();
    settings["reference"] =
        survey.reference ? survey.reference->observations.filename().string() : "";
    settings["seed"] = survey.survey.seed;
    settings["from_utc"] = survey.from ? to_rfc3339(*survey.from) : "";
    settings["to_utc"] = survey.to ? to_rfc3339(*survey.to) : "";
    settings["amendments"] = reading::amendments_json(read.amendments.list);
    settings["warnings"] = text::in_english(read.warnings);
    return settings;
}

/// A survey day, corrected but not yet written, or the reason why it is not corrected.
struct Day {
    std::string name;
    std::optional<model::SurveyCorrection> result = {};
    std::string trouble = {};  ///< Without a result.
    std::string amendments = {};
    std::vector<text::NamedText> files = {};
    std::optional<reading::DayRecord> record = {};
    std::string serial_number = {};
};

/// Returns the name as one part of a path.
std::string folder_name(std::string name) {
    std::replace(name.begin(), name.end(), '/', '-');
    if (name.starts_with('.')) name.front() = '-';
    return name;
}

Day correct_day(const job::SurveyFile& survey, const figure::FigureOptions& figures) {
    text::ProgressBar bar(survey.name);
    reading::OccupationRows read = job::read_survey(survey, std::ref(bar));
    Day day{survey.name, job::correct_survey_day(survey, read)};
    model::SurveyCorrection& result = *day.result;
    if (survey.bouguer_density_kg_per_m3)
        result::add_anomalies(result.stations, read.sites, *survey.bouguer_density_kg_per_m3);
    day.record = read.day;
    day.serial_number = read.serial_number;
    day.amendments = reading::amendments_text(read.amendments.list);
    const nlohmann::ordered_json settings = settings_of(survey, result, read);
    day.files = result::result_files(result, settings, read.inputs, read.sites);
    report::Report report = report::make_report(
        result, settings,
        {survey.name, read.sites, std::move(read.records), std::move(read.temperature_course),
         std::move(read.signal), read.data_sheet_mgal_per_sqrt_hz, read.inputs, read.warnings,
         figures});
    std::ranges::move(report.files, std::back_inserter(day.files));
    read.warnings.insert(read.warnings.end(), report.warnings.begin(), report.warnings.end());
    print_warnings(read.warnings, survey.name + ": ");
    return day;
}

/// Writes and prints the common results of the corrected days.  Their order has no effect.
void write_joint(std::vector<Day> days, const std::filesystem::path& out,
                 const figure::FigureOptions& figures) {
    std::ranges::sort(days, {}, [](const Day& day) {
        return std::tuple(day.result ? day.result->rows.front().row.time : UtcTime::max(),
                          day.serial_number, day.name);
    });
    std::vector<model::RecordedSurvey> surveys;
    std::vector<report::JointDay> pages;
    for (const Day& day : days) {
        const model::SurveyCorrection* const result = day.result ? &*day.result : nullptr;
        pages.push_back({day.name, folder_name(day.name), result, day.trouble});
        if (result != nullptr)
            surveys.push_back(
                {day.name, day.serial_number, result, day.record ? &*day.record : nullptr});
    }
    const result::JointResult joint = model::adjust_jointly(surveys);
    const auto* const adjustment = std::get_if<model::JointAdjustment>(&joint);
    const result::JointTables tables = result::joint_tables(surveys, adjustment);
    const std::vector<result::UnitDay> units = result::unit_days(surveys);
    std::vector<text::NamedText> files{
        {"joint.csv", result::csv_table(result::joint_columns(), tables.stations)},
        {"joint-differences.csv",
         result::csv_table(result::difference_columns(), tables.differences)},
        {"joint.json", result::joint_json(joint, tables)},
        {"history.csv", result::csv_table(result::unit_day_columns(), units)},
        {"terms.csv", result::csv_table(result::term_summary_columns(), result::summarise(units))}};
    report::Report page = report::make_joint_page(pages, joint, units, figures);
    std::ranges::move(page.files, std::back_inserter(files));
    text::write_together(out, files);
    print_warnings({page.warnings.begin(), page.warnings.end()});
    std::cout << (surveys.size() == days.size() ? "all days\n" : "all corrected days\n");
    for (const std::string& sentence : result::joint_sentences(joint))
        std::cout << sentence << '\n';
    std::cout << result::aligned_text(
                     adjustment != nullptr
                         ? result::table_of(
                               result::with_decimals(result::joint_columns(),
                                                     result::decimals_of(*surveys.front().result)),
                               tables.stations)
                         : result::table_by_survey(tables.stations, surveys, false))
              << '\n';
}

void correct_days(const SurveyCommandOptions& options) {
    std::vector<job::SurveyFile> surveys;
    std::set<std::string> names;
    for (const std::string& file : options.files) {
        surveys.push_back(with_overrides(read_survey_of(file, options.sites), options));
        if (!names.insert(folder_name(surveys.back().name)).second) {
            throw InputError(fmt::format(
                "{}: survey.name = {}: used by two days; allowed: a different name for each day",
                file, surveys.back().name));
        }
    }
    if (options.is_json) {
        if (surveys.size() > 1)
            throw InputError("--json: more than one survey; allowed: one survey file or data root");
        print_gravity_so_far(std::move(surveys.front()));
        return;
    }
    const std::filesystem::path out = options.out.empty()
                                          ? surveys.front().path.parent_path() / "result"
                                          : std::filesystem::path(options.out);
    require_folder_option("--out", out);
    std::vector<job::SurveyFile> units;
    for (const job::SurveyFile& survey : surveys)
        std::ranges::move(job::by_unit(survey), std::back_inserter(units));
    surveys = std::move(units);
    const bool is_joint = surveys.size() > 1;
    std::vector<Day> days;
    std::vector<std::string> troubles;
    for (const job::SurveyFile& survey : surveys) try {
            days.push_back(correct_day(survey, options.figures));
        } catch (const InputError& error) {
            days.push_back({.name = survey.name, .trouble = error.what()});
            troubles.push_back(survey.name + ": " + error.what());
        }
    if (troubles.size() == days.size())
        throw InputError(is_joint ? text::joined(troubles, "; ") : days.front().trouble);
    for (const Day& day : days) {
        if (!day.result) continue;
        text::write_together(is_joint ? out / folder_name(day.name) : out, day.files);
        if (is_joint) std::cout << "survey " << day.name << '\n';
        std::cout << result::survey_text(*day.result, options.is_verbose) << day.amendments << '\n';
    }
    if (is_joint) write_joint(std::move(days), out, options.figures);
    std::cout << "written to " << out.string() << '\n';
    if (!troubles.empty())
        throw std::runtime_error(
            fmt::format("{} of {} surveys are not corrected, the others are written: {}",
                        troubles.size(), surveys.size(), text::joined(troubles, "; ")));
}

}  // namespace

void add_survey_command(CLI::App& program) {
    CLI::App& command =
        *program.add_subcommand("survey", "Corrects survey days from the archive of a data root.");
    const auto options = std::make_shared<SurveyCommandOptions>();
    add_required(
        command, "FILE", "", options->files,
        "Survey files (TOML), one per day, data roots, or unpacked folders of a351ctl bundle");
    add_option(command, "--sites", "FILE", options->sites,
               "Table of the sites of a data root (default: sites.csv in the folder that contains "
               "the root)");
    command.add_flag("--json", options->is_json,
                     "Print the gravity so far as one JSON document and write no file. Includes "
                     "the running stay and data that are not archived yet");
    add_option(command, "--out", "DIR", options->out,
               "Folder of the result (default: result beside the first survey file); several days "
               "have one folder each in it");
    add_option(command, "--model", "NAME", options->model, "Model of the instrument")
        ->check(CLI::IsMember(model::model_names()));
    add_option(command, "--flags", "RULE", options->flags,
               "use: occupations with used = 0 are not used in the fit; ignore: they are used")
        ->check(CLI::IsMember({"use", "ignore"}));
    add_option(command, "--tide", "SOURCE", options->tide,
               "Tide, as its effect on gravity, that is subtracted from the readings: " +
                   std::string(tide::kTideSources));
    add_tide_system(command, options->tide_system);
    add_option(command, "--trend", "NAME", options->trend,
               "Trend that is averaged; the model paper always uses eemd")
        ->check(CLI::IsMember({"eemd", "smoother"}));
    add_option(command, "--calibration", "FILE", options->calibration,
               "Calibration of the unit, made by a351-correct calibrate");
    add_option(command, "--from", "UTC", options->from,
               "Use occupations that start at or after this instant (RFC 3339). Default: the last "
               "survey day in the log; days are separated by a pause of six hours");
    add_option(
        command, "--to", "UTC", options->to,
        "Use occupations that start before this instant (RFC 3339). Default: the end of the log");
    add_figure_options(command, options->figures);
    add_verbose_flag(command, options->is_verbose);
    command.callback([options] { correct_days(*options); });
}

}  // namespace a351::corrector::command
