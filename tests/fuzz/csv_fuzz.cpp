/// @file
/// Tables in CSV.  Both readers must return the same cells.  Sites, occupations and tide series
/// must be accepted, or refused by an InputError of one line.

#include <algorithm>
#include <sstream>
#include <vector>

#include "corrector/reading/occupation_list.hpp"
#include "corrector/tide/tide_series.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/sites.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using fuzz::require;

template <class Read>
void take_or_refuse(Read read) {
    try {
        read();
    } catch (const InputError& error) {
        require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
}

void compare_readers(const std::string& input) {
    const text::CsvTable table = text::CsvTable::parse(input, "input.csv");
    std::istringstream in(input);
    text::CsvReader reader(in, "input.csv");
    std::size_t row = 0;
    for (; reader.next(); ++row) {
        const auto& cells = reader.cells();
        if (cells.size() > 1 && std::ranges::all_of(cells, &std::string_view::empty)) {
            --row;  // The table has no empty rows.
            continue;
        }
        require(row < table.row_count());
        for (std::size_t i = 0; i < reader.columns().size(); ++i) {
            const std::string& column = reader.columns()[i];
            require(table.cell(row, column) == reader.cells()[i]);
            if (const auto number = text::parse_number(reader.cells()[i])) {
                require(text::parse_number(text::shortest(*number)) == *number);
            }
        }
    }
    require(row == table.row_count());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(fuzz::text_of(data, size));
    const auto file = fuzz::file_of(input, "input.csv");
    take_or_refuse([&] { compare_readers(input); });
    take_or_refuse([&] { (void)text::read_sites(file); });
    take_or_refuse([&] { (void)corrector::tide::Series::read(file); });
    text::Site site;
    site.name = "No.5";
    take_or_refuse([&] { (void)corrector::reading::read_occupation_table(file, {site}); });
    return 0;
}
