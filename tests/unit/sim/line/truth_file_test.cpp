#include <fstream>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/sim/truth_reader.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::truth;

TEST_CASE("a truth file replaces an empty file or a truth file, and no other file") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "truth.bin";
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
}

TEST_CASE("a truth file gives its records back") {
    const test::TemporaryDirectory directory;
    truth::Record record;
    record.utc = *parse_rfc3339("2017-07-16T00:00:00.020Z");
    record.values.axes = {-1, 2, -2147483647};
    record.values.temperature = -1981;
    record.values.count = 65520;
    record.sampling_run = 3;
    record.grid_index = 4'000'000'000U;
    record.fate = Fate::misplaced;
    truth::Writer writer(directory.path() / "truth.bin");
    writer.append(record);
    writer.append({});
    writer.close();
    CHECK(std::filesystem::file_size(directory.path() / "truth.bin") == 16 + 2 * 40);
    const auto records = read_truth(directory.path() / "truth.bin");
    REQUIRE(records.size() == 2);
    CHECK(records[0].utc == record.utc);
    CHECK(records[0].values == record.values);
    CHECK(records[0].sampling_run == 3);
    CHECK(records[0].grid_index == 4'000'000'000U);
    CHECK(records[0].fate == Fate::misplaced);
    CHECK(records[1].fate == Fate::intact);
}
