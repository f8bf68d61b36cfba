#include <unistd.h>

#include <fstream>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/unit/sim/truth_reader.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::truth;

TEST_CASE("a truth file replaces an empty file or a truth file, and no other file",
          "[sim][truth]") {
    const auto file =
        std::filesystem::temp_directory_path() / ("a351_truth_" + std::to_string(::getpid()));
    const auto write = [&file](std::string_view text) { std::ofstream(file) << text; };
    for (const std::string_view foreign : {"A", "A351TRU1", "title = \"mine\"\n"}) {
        write(foreign);
        CHECK_THROWS_AS(truth::Writer(file), InputError);
        CHECK(text::read_text_file(file) == foreign);
    }
    write("");
    for (int time = 0; time < 2; ++time) {  // Empty, then a truth file.
        truth::Writer writer(file);
        writer.append({});
        writer.close();
        CHECK(read_truth(file).size() == 1);
    }
    std::filesystem::remove(file);
}
