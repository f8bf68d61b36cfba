#include "corrector/report/page_parts.hpp"

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/inline_svg.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {
namespace {

const std::string* find_picture(const Drawing& drawing, const std::string& file) {
    for (const text::NamedText& picture : drawing.pictures) {
        if (picture.first == file) return &picture.second;
    }
    return nullptr;
}

std::string figure_html(const Figure& figure, const Drawing& drawing) {
    const std::string* const picture = find_picture(drawing, figure.name + ".svg");
    const auto svg = picture != nullptr ? inline_svg(*picture, figure.name + "-") : std::nullopt;
    return "<figure>\n" + svg.value_or("<p><em>This figure is missing.</em></p>") +
           "\n<figcaption>" + html_text(figure.caption) + " <code>" + figure.name +
           ".gp</code></figcaption>\n</figure>\n";
}

}  // namespace

std::string figures_html(const std::vector<Figure>& figures, const Drawing& drawing) {
    std::string large, small;
    for (const Figure& figure : figures) {
        (figure.is_small ? small : large) += figure_html(figure, drawing);
    }
    return large + (small.empty() ? "" : "<div class=\"small\">\n" + small + "</div>\n");
}

std::vector<std::string> missing_lines(const std::vector<std::string>& troubles) {
    if (troubles.empty()) return {};
    const std::size_t others = troubles.size() - 1;
    return {"figures are missing: " + clean_utf8(troubles.front()) +
            (others == 0 ? std::string() : "; " + std::to_string(others) + " more such")};
}

std::string section(const std::string& title, const std::string& html) {
    return "<section>\n<h2>" + html_text(title) + "</h2>\n" + html + "</section>\n";
}

void add_figure_files(std::vector<text::NamedText>& files, const std::vector<Figure>& figures,
                      Drawing& drawing) {
    for (const Figure& figure : figures) {
        files.emplace_back("figures/" + figure.name + ".gp", figure.script);
        if (!figure.data.empty())
            files.emplace_back("figures/" + figure.name + ".dat", figure.data);
    }
    for (text::NamedText& picture : drawing.pictures)
        files.emplace_back("figures/" + picture.first, std::move(picture.second));
}

}  // namespace a351::corrector
