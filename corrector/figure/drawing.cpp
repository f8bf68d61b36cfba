#include "corrector/figure/drawing.hpp"

#include <fmt/core.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "protocol/child/child_program.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::corrector::figure {
namespace {

/// Time limit of one run of gnuplot.  Reason: a hundred figures take some 5 s on a slow laptop.
constexpr std::chrono::seconds kTimeLimit(60);

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "a351-figures-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw std::system_error(errno, std::generic_category(), "folder for figures");
        path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    void write(const std::string& name, const std::string& content) const {
        std::ofstream out(path_ / name, std::ios::binary);
        out << content;
        if (!out.flush())
            throw std::system_error(EIO, std::generic_category(), "folder for figures: " + name);
    }

private:
    std::filesystem::path path_;
};

child::ChildEnd run_gnuplot(const TemporaryFolder& folder, const std::vector<std::string>& names,
                            const std::string& format) {
    // -d: no start-up file of the user or the machine.
    std::vector<std::string> words{"gnuplot", "-d", "-e", "format='" + format + "'"};
    for (const std::string& name : names) words.push_back(name + ".gp");
    // cairo 1.18 (Debian 13) leaves the objects of a PDF file uncompressed with this variable, so
    // that the date of the run can be removed; cairo 1.16 (Debian 12) does so anyway.
    return child::run_child({.words = std::move(words),
                             .directory = folder.path(),
                             .variables = {"LC_ALL=C.UTF-8", "TZ=UTC0", "CAIRO_DEBUG_PDF=1"}},
                            {.time = kTimeLimit});
}

std::string trouble_of(const child::ChildEnd& end) {
    if (end.outcome == child::Outcome::missing) return "gnuplot is not installed (not in PATH)";
    return "gnuplot failed: " + end.message;
}

/// Replaces the time of the run, which the PDF library writes in this form and length.
void remove_creation_date(std::string& pdf) {
    constexpr std::string_view kKey = "/CreationDate (D:";
    constexpr std::string_view kNever = "19700101000000";
    const std::size_t at = pdf.find(kKey);
    if (at == std::string::npos || at + kKey.size() + kNever.size() > pdf.size()) return;
    pdf.replace(at + kKey.size(), kNever.size(), kNever);
}

void draw_format(const TemporaryFolder& folder, const std::vector<std::string>& names,
                 const std::string& format, Drawing& drawing) {
    using enum child::Outcome;
    const std::string ending = "." + format;
    child::ChildEnd end = run_gnuplot(folder, names, format);
    std::vector<std::string> drawn;
    if (end.outcome == good) {
        drawn = names;
    } else if (end.outcome == missing || end.outcome == too_slow) {
        drawing.troubles.push_back(trouble_of(end));
    } else {
        for (const std::string& name : names) {
            end = run_gnuplot(folder, {name}, format);
            if (end.outcome == good) {
                drawn.push_back(name);
            } else {
                drawing.troubles.push_back(fmt::format("{}{}: {}", name, ending, trouble_of(end)));
            }
        }
    }
    for (const std::string& name : drawn) {
        const std::string file = name + ending;
        if (!std::filesystem::exists(folder.path() / file)) {
            drawing.troubles.push_back(file + ": gnuplot did not write it");
            continue;
        }
        std::string content = text::read_text_file(folder.path() / file);
        if (format == "pdf") remove_creation_date(content);
        drawing.pictures.emplace_back(file, std::move(content));
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
        const TemporaryFolder folder;
        std::vector<std::string> names;
        for (const Figure& figure : figures) {
            names.push_back(figure.name);
            folder.write(figure.name + ".gp", figure.script);
            if (!figure.data.empty()) folder.write(figure.name + ".dat", figure.data);
        }
        draw_format(folder, names, "svg", drawing);
        for (const std::string& format : formats) draw_format(folder, names, format, drawing);
    } catch (const std::system_error& error) {
        // Tables and text are useful without pictures.
        drawing.troubles.push_back(error.code().message());
    }
    return drawing;
}

}  // namespace a351::corrector::figure
