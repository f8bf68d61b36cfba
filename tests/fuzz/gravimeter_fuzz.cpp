/// @file
/// Files of gravimeters.  Each must be refused by an InputError of one line, or each of its lines is
/// a reading, a comment or refused, and its tables can be read again.

#include <algorithm>
#include <chrono>

#include "corrector/gravimeter/contradictions.hpp"
#include "corrector/gravimeter/site_names.hpp"
#include "corrector/gravimeter/survey_tables.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/sites.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using namespace a351::corrector::gravimeter;
using fuzz::require;

void read_and_write(const std::string& input, const std::filesystem::path& path) {
    std::vector<GravimeterFile> files{read_gravimeter_file(path, {std::chrono::hours(8)})};
    const GravimeterFile& file = files.front();
    const auto ends = static_cast<std::size_t>(std::ranges::count(input, '\n'));
    const std::size_t lines = ends + (input.ends_with('\n') ? 0 : 1);
    require(file.readings.size() + file.comment_count + file.refused.size() == lines);
    for (const RefusedLine& line : file.refused)
        require(line.reason.find('\n') == std::string::npos);

    for (const text::Message& remark : make_table_names(files))
        require(remark.english().find('\n') == std::string::npos);
    for (const Reading& reading : file.readings) {
        require(text::trouble_with_site_name(reading.site).empty());
        require(text::trouble_with_site_name(reading.instrument).empty());
    }
    (void)contradictions(file,
                         [](UtcTime, const corrector::tide::Station&) { return MilliGal(0.0); });
    const auto stays = find_stays(files);
    for (const auto& [name, content] : survey_tables(files, stays, {{}, false}))
        require(text::CsvTable::parse(content, name).row_count() > 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(fuzz::text_of(data, size));
    try {
        read_and_write(input, fuzz::file_of(input, "input.txt"));
    } catch (const InputError& error) {
        require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
