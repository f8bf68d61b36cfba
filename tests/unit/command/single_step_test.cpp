// The single steps of a351-correct as a script sees them: tide, emd, decimate, smooth.
#include <cmath>
#include "tests/unit/command/run_command.hpp"

using namespace a351;

namespace {

void write_sine_on_a_slope(const test::TemporaryDirectory& folder) {
    std::string csv = "v\n";
    for (int i = 0; i < 200; ++i) csv += text::shortest(std::sin(0.3 * i) + 0.01 * i) + '\n';
    folder.write("in.csv", csv);
}

}  // namespace

TEST_CASE("tide writes times and the effect on gravity") {
    const test::TemporaryDirectory folder;
    const std::string arguments =
        "tide --latitude 40.7914 --longitude 282.1414 --height 370 --from 2015-04-23T00:00:00Z "
        "--to 2015-04-23T01:00:00Z --step 1800 --model longman --delta2 1.1575 --delta3 1.1575";
    const Outcome outcome = run(folder, arguments);
    CHECK(outcome.status == 0);
    const auto table = text::CsvTable::parse(outcome.output, "stdout");
    REQUIRE(table.row_count() == 3);
    CHECK(table.cell(0, "time") == "2015-04-23T00:00:00Z");
    CHECK(table.cell(2, "time") == "2015-04-23T01:00:00Z");
    CHECK(table.number(0, "tide_mgal") == Approx(-0.00354).margin(0.00001).epsilon(0));
    const auto mean =
        text::CsvTable::parse(run(folder, arguments + " --tide-system mean").output, "stdout");
    CHECK(mean.cell(0, "tide_system") == "mean");
    // 1.1575 times Ekman's -0.0304 + 0.0912 sin^2(lat)
    CHECK(table.number(0, "tide_mgal") - mean.number(0, "tide_mgal") ==
          Approx(0.00986).margin(0.00025).epsilon(0));
    CHECK(run(folder, arguments + " --tide-system free").status == 2);
    CHECK(run(folder, arguments + " --output tide.csv").output.empty());
    CHECK(text::read_text_file(folder.path() / "tide.csv") == outcome.output);
}

TEST_CASE("emd writes the modes and prints a summary of each") {
    const test::TemporaryDirectory folder;
    write_sine_on_a_slope(folder);
    const std::string arguments = "emd --input in.csv --column v --modes 4 --output ";
    const Outcome outcome =
        run(folder, arguments + "modes.csv --ensemble 20 --pairs --ends mirror");
    CHECK(outcome.status == 0);
    const auto modes = table_of(folder, "modes.csv");
    REQUIRE(modes.row_count() == 200);
    for (std::size_t row = 0; row < 200; ++row) {
        double sum = modes.number(row, "residue");
        for (const char* const mode : {"imf1", "imf2", "imf3", "imf4"})
            sum += modes.number(row, mode);
        const double i = static_cast<double>(row);
        REQUIRE(sum == Approx(std::sin(0.3 * i) + 0.01 * i).margin(1e-12));
    }
    const auto report = text::CsvTable::parse(outcome.output, "stdout");
    REQUIRE(report.row_count() == 5);
    CHECK(report.cell(4, "component") == "residue");
    double share = 0.0;
    for (std::size_t row = 0; row < 5; ++row) share += report.number(row, "energy_share");
    CHECK(share == Approx(1.0));
    CHECK(report.number(0, "standard_error") > 0.0);
    check_refused(run(folder, arguments + "odd.csv --pairs --ensemble 21"),
                  "--ensemble = 21; allowed with --pairs: an even");
}

TEST_CASE("the option --s-number changes the modes of emd and is refused out of range") {
    const test::TemporaryDirectory folder;
    write_sine_on_a_slope(folder);
    const std::string arguments =
        "emd --input in.csv --column v --modes 2 --ensemble 1 --noise 0 --output ";
    std::vector<std::string> modes;
    for (const char* const stopping : {"--s-number 1", "--s-number 8", "--sifts 10"}) {
        CAPTURE(stopping);
        CHECK(run(folder, arguments + "modes.csv " + stopping).status == 0);
        modes.push_back(text::read_text_file(folder.path() / "modes.csv"));
    }
    CHECK(modes[0] != modes[1]);
    CHECK(modes[0] != modes[2]);
    check_refused(run(folder, arguments + "none.csv --s-number 0"), "--s-number = 0");
}

TEST_CASE("decimate counts missing samples and writes the valid values") {
    const test::TemporaryDirectory folder;
    std::string rows = "time_s,a\n";
    for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + (i == 600 ? ",\n" : ",7\n");
    folder.write("in.csv", rows);
    const Outcome outcome =
        run(folder, "decimate --factor 10 --input in.csv --column a --output out.csv");
    CHECK(outcome.status == 0);
    CHECK(outcome.output.empty());
    // The filters of five of the 100 values reach beyond the start, of four beyond the end, and of
    // nine into the gap.
    CHECK_THAT(outcome.errors,
               ContainsSubstring("1000 samples (1 missing) to 100 values (82 valid)"));
    const auto table = table_of(folder, "out.csv");
    REQUIRE(table.row_count() == 100);
    CHECK(table.number(50, "value") == Approx(7.0).epsilon(1e-14));
    CHECK(table.cell(60, "value").empty());
    CHECK(table.cell(60, "valid") == "0");
}

TEST_CASE("a blank line in a single column counts as a missing sample in every step") {
    const test::TemporaryDirectory folder;
    std::string rows = "a\n";
    for (int i = 0; i < 100; ++i) rows += i == 40 ? "\n" : std::to_string(i % 7) + "\n";
    folder.write("in.csv", rows + "\n");
    const std::string input = " --input in.csv --column a";
    CHECK_THAT(run(folder, "decimate --factor 2" + input).errors,
               ContainsSubstring("100 samples (1 missing)"));
    const Outcome smoothed = run(folder, "smooth --cutoff 5" + input);
    CHECK_THAT(smoothed.errors, ContainsSubstring("100 samples (1 missing)"));
    const auto table = text::CsvTable::parse(smoothed.output, "stdout");
    CHECK(table.row_count() == 100);
    CHECK(table.number(40, "weight") == 0.0);
    check_refused(run(folder, "emd --output out.csv" + input), "in.csv:42: a = ");
}

TEST_CASE("each step refuses a gap in the times and times that go back") {
    // After PyEMD #79 and #85.
    const test::TemporaryDirectory folder;
    const char* const time = GENERATE("time", "time_utc", "time_s");
    std::string gap = std::string(time) + ",a\n", back = gap, whole = gap;
    for (int i = 0; i < 60; ++i) {
        const auto row = [&](int second) {
            const std::string at = std::string(time) == "time_s"
                                       ? std::to_string(second)
                                       : to_rfc3339(UtcTime(std::chrono::seconds(second)));
            return at + "," + std::to_string(i % 7) + "\n";
        };
        whole += row(i);
        gap += row(i < 30 ? i : i + 100);
        back += row(i < 30 ? i + 100 : i);
    }
    folder.write("whole.csv", whole);
    folder.write("gap.csv", gap);
    folder.write("back.csv", back);
    for (const std::string step :
         {"emd --output out.csv", "smooth --cutoff 5", "decimate --factor 2"}) {
        CAPTURE(step, time);
        CHECK(run(folder, step + " --input whole.csv --column a").status == 0);
        const Outcome over = run(folder, step + " --input gap.csv --column a");
        CHECK(over.status == 2);
        CHECK_THAT(over.errors, ContainsSubstring("gap.csv:32: ") &&
                                    ContainsSubstring("101 s after the row before it"));
        check_refused(run(folder, step + " --input back.csv --column a"),
                      "not after the row before it");
    }
}

TEST_CASE("smooth reports that its weights did not converge") {
    const test::TemporaryDirectory folder;
    folder.write("in.csv", "a\n57\n50\n60\n1\n11\n5\n5\n2\n6\n9\n7\n4\n");
    const Outcome outcome = run(folder, "smooth --cutoff 10 --input in.csv --column a");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors, ContainsSubstring("did not converge"));
}

TEST_CASE("smooth and decimate refuse too few samples, and samples whose squares overflow") {
    const test::TemporaryDirectory folder;
    folder.write("huge.csv", "a\n1\n1.2e308\n-1.2e308\n3\n");
    folder.write("two.csv", "a,b\n1,0\n,0\n2,0\n");
    for (const std::string command : {"smooth --cutoff 5", "decimate --factor 2"}) {
        const Outcome huge = run(folder, command + " --input huge.csv --column a");
        check_refused(huge, "huge.csv:3: a = 1.2e308: out of range; allowed:");
        CHECK(huge.output.empty());
    }
    check_refused(run(folder, "smooth --cutoff 5 --input two.csv --column a"),
                  "two.csv: a: 2 samples; allowed: 3 or more");
}

TEST_CASE("a time column with unequal steps is refused at the row where the step changes") {
    const test::TemporaryDirectory folder;
    const auto refused = [&](const std::string& times, const std::string& place) {
        folder.write("in.csv", times);
        check_refused(run(folder, "smooth --cutoff 3 --input in.csv --column a"), place);
    };
    refused("time_s,a\n0,1\n2,1\n3,2\n4,1\n5,1\n",
            "in.csv:4: time_s = 3: 1 s after the row before it");
    refused("time_s,a\n0,1\n1,1\n2,2\n3.4,1\n4.8,1\n", "in.csv:5: time_s = 3.4: 1.4 s after");
    refused("time_s,a\n0,1\n1,1\n2,2\n4,1\n5,1\n", "here of 1 s");
    folder.write("in.csv", "time_s,a\n0,1\n1.1,1\n2,2\n3.1,1\n3.9,1\n");
    CHECK(run(folder, "smooth --cutoff 3 --input in.csv --column a").status == 0);
}

TEST_CASE("smooth follows a straight line through a gap and an outlier") {
    const test::TemporaryDirectory folder;
    std::string rows = "a\n";
    for (int i = 0; i < 100; ++i)
        rows += i == 40 ? " ,\n" : std::to_string(i == 60 ? 1000 : 2 * i + i % 2) + ",\n";
    folder.write("in.csv", "a,b\n" + rows.substr(2));
    const Outcome outcome = run(folder, "smooth --cutoff 50 --input in.csv --column a");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors, ContainsSubstring("100 samples (1 missing), noise level 0.5"));
    const auto table = text::CsvTable::parse(outcome.output, "stdout");
    REQUIRE(table.row_count() == 100);
    for (const std::size_t i : {40U, 60U}) {
        CHECK(table.number(i, "value") == Approx(2.0 * static_cast<double>(i) + 0.5).margin(0.1));
        CHECK(table.number(i, "weight") == 0.0);
        CHECK(table.number(i, "standard_error") > table.number(50, "standard_error"));
    }
    CHECK(table.number(50, "weight") == 1.0);
}
