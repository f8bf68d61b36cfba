#include "corrector/figure/drawing.hpp"

#include <stdlib.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>

#include "corrector/figure/gnuplot_script.hpp"
#include "protocol/child/child_program.hpp"
#include "protocol/text/removed_at_end.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::corrector::figure {
namespace {

using child::Outcome;

std::filesystem::path new_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "a351-figures-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw std::system_error(errno, std::generic_category(), "folder for figures");
    return name;
}

child::ChildEnd run_gnuplot(const std::filesystem::path& folder,
                            const std::vector<std::string>& names, const std::string& format) {
    // Reason for the limit: a hundred figures take some 5 s on a slow laptop.
    constexpr std::chrono::seconds kTimeLimit(60);
    // -d: no start-up file of the user or the machine.
    std::vector<std::string> words{"gnuplot", "-d", "-e", "format='" + format + "'"};
    for (const std::string& name : names) words.push_back(name + ".gp");
    // cairo 1.18 (Debian 13) leaves the objects of a PDF file uncompressed with this variable, so
    // that the date of the run can be removed; cairo 1.16 (Debian 12) does so anyway.
    const std::vector<std::string> variables{"LC_ALL=C.UTF-8", "TZ=UTC0", "CAIRO_DEBUG_PDF=1"};
    return child::run_child({words, folder, variables}, {.time = kTimeLimit});
}

/// Replaces the time of the run, which the PDF library writes in this form and length.
void remove_creation_date(std::string& pdf) {
    constexpr std::string_view kKey = "/CreationDate (D:";
    constexpr std::string_view kNever = "19700101000000";
    const std::size_t at = pdf.find(kKey);
    if (at == std::string::npos || at + kKey.size() + kNever.size() > pdf.size()) return;
    pdf.replace(at + kKey.size(), kNever.size(), kNever);
}

/// Draws the figures of these names; if it fails, each of them alone.
void draw_format(const std::filesystem::path& folder, const std::vector<std::string>& names,
                 const std::string& format, Drawing& drawing) {
    const child::ChildEnd end = run_gnuplot(folder, names, format);
    if (end.outcome == Outcome::missing) {
        drawing.troubles.emplace_back("gnuplot is not installed (not in PATH)");
    } else if (end.outcome == Outcome::too_slow) {
        drawing.troubles.push_back("gnuplot failed: " + end.message);
    } else if (end.outcome != Outcome::good && names.size() > 1) {
        for (const std::string& name : names) draw_format(folder, {name}, format, drawing);
    } else {
        for (const std::string& name : names) {
            const std::string file = name + '.' + format;
            if (end.outcome != Outcome::good) {
                drawing.troubles.push_back(file + ": gnuplot failed: " + end.message);
            } else if (!std::filesystem::exists(folder / file)) {
                drawing.troubles.push_back(file + ": gnuplot did not write it");
            } else {
                std::string content = text::read_text_file(folder / file);
                if (format == "pdf") remove_creation_date(content);
                drawing.pictures.emplace_back(file, std::move(content));
            }
        }
    }
}

}  // namespace

const std::vector<std::string>& picture_formats() {
    static const std::vector<std::string> formats{"pdf", "png"};
    return formats;
}

Drawing draw(const std::vector<Figure>& figures, const std::vector<std::string>& formats) {
    Drawing drawing;
    if (figures.empty()) return drawing;
    try {
        const text::RemovedAtEnd folder(new_folder());
        text::write_together(folder.path(), figure_files(figures));
        std::vector<std::string> names;
        for (const Figure& figure : figures) names.push_back(figure.name);
        draw_format(folder.path(), names, "svg", drawing);
        for (const std::string& format : formats)
            draw_format(folder.path(), names, format, drawing);
    } catch (const std::system_error& error) {
        // Tables and text are useful without pictures.
        drawing.troubles.push_back(error.code().message());
    }
    return drawing;
}

}  // namespace a351::corrector::figure
