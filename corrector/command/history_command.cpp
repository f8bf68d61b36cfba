#include <iostream>
#include <memory>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/figure/drawing.hpp"
#include "corrector/figure/history_figure.hpp"
#include "corrector/history/unit_history.hpp"
#include "corrector/report/html.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

struct HistoryOptions {
    std::vector<std::string> results;
    std::string out = "history";
    std::vector<std::string> figures;
};

void show_history(const HistoryOptions& options) {
    require_folder_option("--out", options.out);
    const std::vector<history::UnitDay> days =
        history::read_unit_days({options.results.begin(), options.results.end()});
    const std::vector<history::TermSummary> terms = history::summarise(days);
    std::vector<text::NamedText> files{
        {"history.csv", result::csv_table(history::unit_day_columns(), days)},
        {"terms.csv", result::csv_table(history::term_summary_columns(), terms)}};
    const std::vector<figure::Figure> figures{figure::history_figure(days)};
    figure::Drawing drawing = figure::draw(figures, options.figures);
    report::add_figure_files(files, figures, drawing);
    text::write_together(options.out, files);
    for (const std::string& warning : report::missing_lines(drawing.troubles))
        std::cerr << "a351-correct: " << warning << '\n';
    std::cout << result::aligned_text(result::table_of(history::unit_day_columns(), days)) << '\n'
              << result::aligned_text(result::table_of(history::term_summary_columns(), terms))
              << "written to " << options.out << '\n';
}

}  // namespace

void add_history_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "history", "Shows constant, slopes and noise of a unit over the days of a season.");
    const auto options = std::make_shared<HistoryOptions>();
    add_required(command, "RESULT", "", options->results,
                 "Results of a351-correct survey: result.json, or the folder with it");
    add_with_default(command, "--out", "DIR", options->out, "Folder of the history");
    add_figures_option(command, options->figures);
    command.callback([options] { show_history(*options); });
}

}  // namespace a351::corrector::command
