#include "corrector/report/html.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/inline_svg.hpp"

namespace a351::corrector::report {
namespace {

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 14mm 13mm; }
body { font: 15px/1.45 "Liberation Sans", Arial, Helvetica, sans-serif; color: #111;
  max-width: 62em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0 0 .2em; }
h2 { font-size: 1.2em; margin: 1.8em 0 .4em; border-bottom: 1px solid #999; }
h3 { font-size: 1em; margin: 1.2em 0 .3em; }
p { margin: .4em 0; }
ul { margin: .4em 0; padding-left: 1.4em; }
table { border-collapse: collapse; margin: .5em 0; font-size: .85em;
  font-variant-numeric: tabular-nums; }
th, td { padding: .12em .55em; border-bottom: 1px solid #ddd; vertical-align: top; }
th { border-bottom: 1px solid #555; text-align: left; vertical-align: bottom; }
.r { text-align: right; }
td.r, .n { white-space: nowrap; }
.wide { overflow-x: auto; }
.many { margin: 0 min(0px, (66em - 100vw) / 2); }
.many table { margin-left: auto; margin-right: auto; }
.many th, .many td { padding: .12em .35em; }
figure { margin: 1em 0; break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; max-height: 235mm; }
figcaption { font-size: .85em; color: #333; }
.small { display: grid; grid-template-columns: 1fr 1fr; gap: 0 1em; }
.small figure { margin: .5em 0; }
code { font-size: .95em; }
pre { font-size: .85em; white-space: pre-wrap; border-left: 3px solid #999; padding-left: .8em; }
@media screen and (max-width: 40em) {
  th, td { padding: .12em .3em; }
  figure { overflow-x: auto; }
  figure svg { width: 40em; }
  figcaption { position: sticky; left: 0; }
  .small { grid-template-columns: 1fr; }
  .small figure svg { width: 100%; }
}
@media print {
  body { font-size: 9.5pt; max-width: none; margin: 0; padding: 0; }
  h2, h3 { break-after: avoid; }
  section.first { break-after: page; }
  tr { break-inside: avoid; }
  thead { display: table-header-group; }
  .wide { overflow: visible; }
  .many { margin: 0; }
  .many table { font-size: 6.4pt; margin: .5em 0; }
  .many th, .many td { padding: .1em .25em; }
}
)";

std::string cell(std::string_view tag, char alignment, std::string_view text) {
    return fmt::format("<{0}{1}>{2}</{0}>", tag,
                       alignment == 'l' ? "" : fmt::format(" class=\"{}\"", alignment),
                       figure::html_text(text));
}

std::string line(std::string_view tag, std::string_view alignment, const HtmlCells& cells) {
    std::string html = "<tr>";
    for (std::size_t i = 0; i < alignment.size(); ++i) html += cell(tag, alignment[i], cells.at(i));
    return html + "</tr>\n";
}

std::string figure_html(const figure::Figure& figure, const figure::Drawing& drawing) {
    const auto picture =
        std::ranges::find(drawing.pictures, figure.name + ".svg", &text::NamedText::first);
    const auto svg = picture == drawing.pictures.end()
                         ? std::nullopt
                         : figure::inline_svg(picture->second, figure.name + "-");
    return fmt::format("<figure>\n{}\n<figcaption>{} <code>{}.gp</code></figcaption>\n</figure>\n",
                       svg.value_or("<p><em>This figure is missing.</em></p>"),
                       figure::html_text(figure.caption), figure.name);
}

}  // namespace

std::string html_table(std::string_view alignment, const HtmlCells& header,
                       const std::vector<HtmlCells>& rows) {
    constexpr std::size_t kMany = 12;  // more columns do not fit on A4 at the normal text size
    std::string html =
        alignment.size() > kMany ? "<div class=\"wide many\">" : "<div class=\"wide\">";
    html += "<table>\n<thead>" + line("th", alignment, header) + "</thead>\n<tbody>\n";
    for (const HtmlCells& row : rows) html += line("td", alignment, row);
    return html + "</tbody></table></div>\n";
}

std::string html_table(const result::Table& table) {
    HtmlCells headings = table.headings;
    for (std::string& heading : headings)
        if (const auto at = heading.find("degC"); at != std::string::npos)
            heading.replace(at, 4, "\u00B0C");
    return html_table(table.alignment, headings, table.rows);
}

std::string html_paragraph(std::string_view text) {
    return "<p>" + figure::html_text(text) + "</p>\n";
}

std::string html_list(const std::vector<std::string>& items) {
    std::string html;
    for (const std::string& item : items)
        html += fmt::format("<li>{}</li>\n", figure::html_text(item));
    return html.empty() ? html : fmt::format("<ul>\n{}</ul>\n", html);
}

std::string figures_html(const std::vector<figure::Figure>& figures,
                         const figure::Drawing& drawing) {
    std::string large, small;
    for (const figure::Figure& figure : figures)
        (figure.is_small ? small : large) += figure_html(figure, drawing);
    return large + (small.empty() ? "" : "<div class=\"small\">\n" + small + "</div>\n");
}

std::string section(std::string_view title, std::string_view html) {
    return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", figure::html_text(title), html);
}

std::string html_page(std::string_view title, std::string_view body) {
    return fmt::format(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{}</title>\n"
        "<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
        figure::html_text(title), kStyle, body);
}

std::vector<std::string> missing_lines(const std::vector<std::string>& troubles) {
    if (troubles.empty()) return {};
    const std::size_t others = troubles.size() - 1;
    return {fmt::format("figures are missing: {}{}", figure::clean_utf8(troubles.front()),
                        others == 0 ? "" : fmt::format("; {} more such", others))};
}

void add_figure_files(std::vector<text::NamedText>& files,
                      const std::vector<figure::Figure>& figures, figure::Drawing& drawing) {
    for (const figure::Figure& figure : figures) {
        files.emplace_back("figures/" + figure.name + ".gp", figure.script);
        if (!figure.data.empty())
            files.emplace_back("figures/" + figure.name + ".dat", figure.data);
    }
    for (text::NamedText& picture : drawing.pictures)
        files.emplace_back("figures/" + picture.first, std::move(picture.second));
}

}  // namespace a351::corrector::report
