#include <iostream>
#include <memory>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/design/design_files.hpp"
#include "corrector/figure/design_figure.hpp"
#include "corrector/figure/drawing.hpp"
#include "corrector/report/html.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

struct DesignOptions {
    std::string plan, sites, unit;
    std::string out = "design";
    figure::FigureOptions figures;
    bool is_json = false;
};

void design_survey(const DesignOptions& options) {
    require_folder_option("--out", options.out);
    const std::vector<text::Site> sites = text::read_sites(options.sites);
    const design::Plan plan = design::read_plan(options.plan, sites);
    const design::PlannedUnit unit =
        options.unit.empty() ? design::usual_unit() : design::planned_unit(options.unit);
    std::vector<text::InputFile> inputs{text::describe_input("plan", options.plan),
                                        text::describe_input("sites", options.sites)};
    if (!options.unit.empty()) inputs.push_back(text::describe_input("unit", options.unit));

    const design::Design design = design::make_design(plan, sites, unit);
    std::vector<text::NamedText> files = design::design_files(design, inputs);
    const std::vector<figure::Figure> figures{
        figure::design_figure(design.errors, options.figures.print)};
    figure::Drawing drawing = figure::draw(figures, options.figures.formats);
    report::add_figure_files(files, figures, drawing);
    text::write_together(options.out, files);
    const std::vector<std::string> missing = report::missing_lines(drawing.troubles);
    print_warnings({missing.begin(), missing.end()});
    if (options.is_json)
        std::cout << design::design_json(design, inputs);
    else
        std::cout << design::design_text(design) << "written to " << options.out << '\n';
}

}  // namespace

void add_design_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "design",
        "Computes the uncertainty of a planned survey, and finds changes that would improve it.");
    const auto options = std::make_shared<DesignOptions>();
    add_required(
        command, "PLAN", "", options->plan,
        "Plan (CSV): site, start_utc, set_ups, minutes_each and, if the box is turned over, faces; "
        "one line per visit, in order");
    add_required(command, "--sites", "CSV", options->sites,
                 "Benchmarks; those with a gravity are known");
    add_option(command, "--unit", "FILE", options->unit,
               "The unit: calibration.toml of a351-correct calibrate, or result.json of an earlier "
               "day corrected with the model day (default: a usual unit)");
    add_with_default(command, "--out", "DIR", options->out, "Folder of the result");
    command.add_flag("--json", options->is_json, "Print design.json instead of the tables");
    add_figure_options(command, options->figures);
    command.callback([options] { design_survey(*options); });
}

}  // namespace a351::corrector::command
