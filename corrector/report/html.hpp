#pragma once
/// @file
/// A page of HTML 5 that is also well-formed XML, built of nodes.
///
/// Texts are nodes, which pugixml escapes when it writes the page.  They may have any bytes:
///
///     Page page(title);
///     const pugi::xml_node stations = page.add_section("Stations");
///     add_table(stations, "u is a standard uncertainty.", table_of(station_columns(), values));
///     const std::string html = page.text();
///
/// A page needs no other file: style and pictures are in it, and there is no script.

#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "corrector/result/table.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::report {

/// A page: its title, a list of contents with links, and sections.  Its nodes are valid as long as
/// the page.
class Page {
public:
    /// @param title  title of the window and heading of the page.
    explicit Page(const std::string& title);

    /// Returns the place for what is before the first section.
    [[nodiscard]] pugi::xml_node body() const { return body_; }

    /// Adds a section with its title, lists it in the contents and returns it.
    /// @param title  different from those of the other sections; ASCII.
    pugi::xml_node add_section(const std::string& title);

    /// Returns the whole page in UTF-8.
    [[nodiscard]] std::string text() const;

private:
    pugi::xml_document document_;
    pugi::xml_node body_, contents_;
};

/// Cells of a line of a table, as plain text.
using HtmlCells = std::vector<std::string>;

/// Adds an element with a text, which may be empty, and returns it.
pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text);
/// Adds a text to an element, after its other content.
void add_text(pugi::xml_node parent, const std::string& text);
/// Adds an element without a text and returns it.  Its class is left out if it is empty.
pugi::xml_node add_part(pugi::xml_node parent, const char* tag, const char* name_of_class = "");

/// Adds a table with its caption.
/// @param caption    says which kind of error the table shows: in sample, left out, u.
/// @param alignment  a letter per column: l left, n left without line breaks, r right (numbers).
/// @param header     one cell per letter, like every row.
/// @param rows       lines in order; may be empty.  Cells beyond the letters are left out.
/// @throws std::out_of_range  the header or a row has fewer cells than there are letters.
void add_table(pugi::xml_node parent, const std::string& caption, std::string_view alignment,
               const HtmlCells& header, const std::vector<HtmlCells>& rows);

/// Adds a table for people, with degC as the degree sign and C.  This change concerns headings
/// only, once in each.
void add_table(pugi::xml_node parent, const std::string& caption, const result::Table& table);

/// Adds a list with bullets; nothing without items.
void add_list(pugi::xml_node parent, const std::vector<std::string>& items);

/// Adds the pictures with their captions; small ones are side by side, after the others.
///
/// A figure without an SVG in `drawing` has a note that it is missing.  Each caption ends with the
/// name of the script, so that a reader finds it.
/// @param drawing  result of draw() for these and possibly other figures.  Call this function
///                 before add_figure_files(), which empties it.
void add_figures(pugi::xml_node parent, const std::vector<figure::Figure>& figures,
                 const figure::Drawing& drawing);

/// Returns one line for all missing figures: the first reason and the number of others; none
/// without troubles.
/// @param troubles  Drawing::troubles.
[[nodiscard]] std::vector<std::string> missing_lines(const std::vector<std::string>& troubles);

/// Adds figures/NAME.gp and .dat, then the pictures, which are moved out of `drawing`.
///
/// Afterwards the pictures in `drawing` must not be used.  A figure without data gets no .dat.
/// @param files  grows at its end; for text::write_together().
void add_figure_files(std::vector<text::NamedText>& files,
                      const std::vector<figure::Figure>& figures, figure::Drawing& drawing);

}  // namespace a351::corrector::report
