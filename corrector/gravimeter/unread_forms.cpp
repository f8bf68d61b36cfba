#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"

namespace a351::corrector::gravimeter {
namespace {

using Cells = std::vector<std::string_view>;

/// A form that is known and not read.
struct UnreadForm {
    bool (*has)(std::string_view line);
    std::string_view name, remedy;
};

/// Returns true if a line is a reading with the usual columns of a form.
template <Form form>
bool is_reading(const Cells& cells) {
    static const Layout layout = usual_layout(form, usual_names(form));
    Fields fields(layout, cells);
    (void)fields.time();
    return fields.trouble().empty();
}

bool is_number_of(std::string_view cell, std::size_t digits) {
    return cell.size() == digits && cell.find_first_not_of("0123456789") == std::string_view::npos;
}

const std::array<UnreadForm, 9> kForms{{
    {[](std::string_view line) { return is_reading<Form::cg5>(split_at_blanks(line)); },
     "readings of a Scintrex CG-5 without its header",
     "put the lines of the instrument from CG-5 SURVEY on before them"},
    {[](std::string_view line) { return is_reading<Form::cg6>(split_at(line, '\t')); },
     "readings of a Scintrex CG-6 without its header",
     "put the lines of the instrument from CG-6 Survey to the names of columns before them"},
    {[](std::string_view line) { return line.find("SCINTREX V") != std::string_view::npos; },
     "a file of a Scintrex CG-3", "make a table of observations"},
    {[](std::string_view line) { return line.starts_with("[TSF-file]"); },
     "a series for Tsoft (TSF)", "give the file of the instrument"},
    {[](std::string_view line) {
         const Cells cells = split_at(line, ',');
         return std::ranges::find(cells, "GRAV.") != cells.end() &&
                std::ranges::find(cells, "TIDE") != cells.end();
     },
     "a table for GSadjust (csv)", "it does not say the instrument: make a table of observations"},
    {[](std::string_view line) {
         constexpr std::size_t kCells = 17, kDate = 11;
         const Cells cells = split_at_blanks(line);
         return cells.size() == kCells && is_number_of(cells[kDate], 6) &&
                is_number_of(cells[kDate + 1], 6);
     },
     "readings prepared by pyGrav for MCGravi", "give the file of the instrument"},
    {[](std::string_view line) {
         return line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF");
     },
     "a text in UTF-16", "save it as UTF-8"},
    {[](std::string_view line) { return line.starts_with("PK\x03\x04"); },
     "a spreadsheet or an archive (zip)", "save the table as text, or unpack the archive"},
    {[](std::string_view line) { return line.starts_with("Micro-g"); },
     "a report of an absolute gravimeter", "put its value into sites.csv as gravity_mgal"},
}};

}  // namespace

std::string unread_form(std::string_view line) {
    for (const UnreadForm& form : kForms)
        if (form.has(line)) return fmt::format("{}, which is not read: {}", form.name, form.remedy);
    return {};
}

}  // namespace a351::corrector::gravimeter
