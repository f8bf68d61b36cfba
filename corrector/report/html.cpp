#include "corrector/report/html.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/gnuplot_script.hpp"
#include "corrector/figure/inline_svg.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {
namespace {

constexpr const char* kStyle = R"(
@page { size: A4; margin: 14mm 13mm; }
body { font: 15px/1.45 "Liberation Sans", Arial, Helvetica, "Noto Sans CJK JP", sans-serif; color: #111;
  max-width: 70em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0 0 .2em; }
h2 { font-size: 1.2em; margin: 1.8em 0 .4em; border-bottom: 1px solid #999; }
h3 { font-size: 1em; margin: 1.2em 0 .3em; }
p { margin: .4em 0; }
ul, ol { margin: .4em 0; padding-left: 1.4em; }
nav ul { display: flex; flex-wrap: wrap; gap: 0 1.2em; list-style: none; padding: 0; }
table { border-collapse: collapse; margin: .3em 0 .5em; font-size: .85em;
  font-variant-numeric: tabular-nums; }
th, td { padding: .12em .55em; border-bottom: 1px solid #ddd; vertical-align: top; }
th { border-bottom: 1px solid #555; text-align: left; vertical-align: bottom; }
.r { text-align: right; }
td.r, .n { white-space: nowrap; }
figure { margin: 1em 0; break-inside: avoid; }
figure.table { overflow-x: auto; break-inside: auto; }
figure svg { display: block; width: 100%; height: auto; max-height: 235mm; }
figcaption { font-size: .85em; color: #333; }
.answer { font-size: 1.25em; font-weight: bold; }
.first { display: flex; flex-wrap: wrap; gap: 0 1.5em; align-items: flex-start; }
.first figure { flex: 1 1 24em; min-width: 0; margin: .4em 0; }
.first figure.table { flex: 0 1 30em; display: flex; flex-direction: column-reverse; }
.first .small { flex: 1 1 24em; grid-template-columns: 1fr; }
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
  h2, h3, figure.table figcaption { break-after: avoid; }
  tr { break-inside: avoid; }
  thead { display: table-header-group; }
  figure.table { overflow: visible; }
  table { font-size: 7pt; }
  th, td { padding: .1em .3em; }
}
)";

/// Returns the name of a section for links; letters outside ASCII stay.
std::string anchor(std::string title) {
    std::ranges::replace_if(
        title,
        [](char c) {
            const auto byte = static_cast<unsigned char>(c);
            return byte < 0x80 && std::isalnum(byte) == 0;
        },
        '-');
    return "section-" + title;
}

void add_line(pugi::xml_node part, const char* tag, std::string_view alignment,
              const HtmlCells& cells) {
    const pugi::xml_node line = add_part(part, "tr");
    for (std::size_t i = 0; i < alignment.size(); ++i) {
        pugi::xml_node cell = add(line, tag, cells.at(i));
        if (alignment[i] != 'l')
            cell.append_attribute("class") = std::string(1, alignment[i]).c_str();
    }
}

void add_figure(pugi::xml_node parent, const figure::Figure& figure,
                const figure::Drawing& drawing) {
    const pugi::xml_node node = add_part(parent, "figure");
    const auto picture =
        std::ranges::find(drawing.pictures, figure.name + ".svg", &text::NamedText::first);
    if (picture == drawing.pictures.end() ||
        !figure::add_svg(node, picture->second, figure.name + "-"))
        add(add_part(node, "p"), "em", text::tr("This figure is missing."));
    const pugi::xml_node caption = add(node, "figcaption", figure.caption + ' ');
    add(caption, "code", figure.name + ".gp");
}

}  // namespace

Page::Page(const std::string& title) {
    document_.append_child(pugi::node_doctype).set_value("html");
    pugi::xml_node html = document_.append_child("html");
    html.append_attribute("xmlns") = "http://www.w3.org/1999/xhtml";
    html.append_attribute("lang") = std::string(text::language().code).c_str();
    pugi::xml_node head = html.append_child("head");
    head.append_child("meta").append_attribute("charset") = "utf-8";
    pugi::xml_node viewport = head.append_child("meta");
    viewport.append_attribute("name") = "viewport";
    viewport.append_attribute("content") = "width=device-width";
    add(head, "title", title);
    head.append_child("style").text().set(kStyle);
    body_ = html.append_child("body");
    add(body_, "h1", title);
    contents_ = add_part(add_part(body_, "nav"), "ul");
}

pugi::xml_node Page::add_section(const std::string& title) {
    const std::string name = anchor(title);
    add(add_part(contents_, "li"), "a", title).append_attribute("href") = ('#' + name).c_str();
    const pugi::xml_node section = add_part(body_, "section");
    add(section, "h2", title).append_attribute("id") = name.c_str();
    return section;
}

std::string Page::text() const {
    std::ostringstream out;
    document_.save(out, "", pugi::format_indent | pugi::format_no_declaration);
    return out.str();
}

pugi::xml_node add_part(pugi::xml_node parent, const char* tag, const char* name_of_class) {
    pugi::xml_node part = parent.append_child(tag);
    if (*name_of_class != '\0') part.append_attribute("class") = name_of_class;
    return part;
}

void add_text(pugi::xml_node parent, const std::string& text) {
    parent.append_child(pugi::node_pcdata).set_value(figure::clean_utf8(text).c_str());
}

pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text) {
    const pugi::xml_node element = parent.append_child(tag);
    add_text(element, text);
    return element;
}

void add_table(pugi::xml_node parent, const std::string& caption, std::string_view alignment,
               const HtmlCells& header, const std::vector<HtmlCells>& rows) {
    const pugi::xml_node node = add_part(parent, "figure", "table");
    add(node, "figcaption", caption);
    const pugi::xml_node table = add_part(node, "table");
    add_line(add_part(table, "thead"), "th", alignment, header);
    const pugi::xml_node body = add_part(table, "tbody");
    for (const HtmlCells& row : rows) add_line(body, "td", alignment, row);
}

void add_table(pugi::xml_node parent, const std::string& caption, const result::Table& table) {
    HtmlCells headings = table.headings;
    for (std::string& heading : headings) {
        heading = text::translated(heading);
        if (const auto at = heading.find("degC"); at != std::string::npos)
            heading.replace(at, 4, "\u00B0C");
    }
    add_table(parent, caption, table.alignment, headings, table.rows);
}

void add_list(pugi::xml_node parent, const std::vector<std::string>& items) {
    if (items.empty()) return;
    const pugi::xml_node list = add_part(parent, "ul");
    for (const std::string& item : items) add(list, "li", item);
}

void add_figures(pugi::xml_node parent, const std::vector<figure::Figure>& figures,
                 const figure::Drawing& drawing) {
    pugi::xml_node side_by_side;
    for (const bool is_small : {false, true}) {
        for (const figure::Figure& figure : figures) {
            if (figure.is_small() != is_small) continue;
            if (is_small && !side_by_side) side_by_side = add_part(parent, "div", "small");
            add_figure(is_small ? side_by_side : parent, figure, drawing);
        }
    }
}

std::vector<std::string> missing_lines(const std::vector<std::string>& troubles) {
    if (troubles.empty()) return {};
    const std::size_t others = troubles.size() - 1;
    return {text::tr("figures are missing: {}", figure::clean_utf8(troubles.front())) +
            (others == 0 ? "" : text::tr("; {} more such", others))};
}

void add_figure_files(std::vector<text::NamedText>& files,
                      const std::vector<figure::Figure>& figures, figure::Drawing& drawing) {
    std::vector<text::NamedText> scripts = figure::figure_files(figures);
    for (auto* const set : {&scripts, &drawing.pictures})
        for (text::NamedText& file : *set)
            files.emplace_back("figures/" + file.first, std::move(file.second));
}

}  // namespace a351::corrector::report
