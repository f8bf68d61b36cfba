// The program a351-correct as a script sees it: exit status, streams and the files of `table`.
#include "tests/unit/command/run_command.hpp"

using namespace a351;

namespace {

const std::string kTsukuba =
    "table --sites '" A351_GOLDEN "/tsukuba/sites.csv' --observations '" A351_GOLDEN
    "/tsukuba/observations.csv' ";

bool has_result(const test::TemporaryDirectory& folder) {
    return std::filesystem::exists(folder.path() / "result");
}

}  // namespace

TEST_CASE("table corrects the published survey and writes the same bytes each time") {
    const test::TemporaryDirectory folder;
    const Outcome first =
        run(folder, kTsukuba + "--model t-rate-drift --flags ignore --verbose --out a");
    CHECK(first.status == 0);
    CHECK(first.errors.empty());
    CHECK(first.output.find("RMS 2.03 mGal (in sample, n = 19)") != std::string::npos);
    CHECK(first.output.find("3.13 mGal (leave-one-station-out)") != std::string::npos);
    CHECK(run(folder, kTsukuba + "--model t-rate-drift --flags ignore --out b").status == 0);
    for (const std::string name :
         {"occupations.csv", "stations.csv", "models.csv", "result.json"}) {
        CAPTURE(name);
        CHECK(text::read_text_file(folder.path() / "a" / name) ==
              text::read_text_file(folder.path() / "b" / name));
    }
}

TEST_CASE("table writes a report in the requested formats, the same bytes each time") {
    const test::TemporaryDirectory folder;
    const std::string arguments = kTsukuba + "--model paper --figures pdf --figures png --out ";
    const Outcome first = run(folder, arguments + "a");
    CHECK(first.status == 0);
    CHECK(first.errors.empty());
    CHECK(run(folder, arguments + "b").status == 0);
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "a")) {
        if (!entry.is_regular_file()) continue;
        ++count;
        const auto name = std::filesystem::relative(entry.path(), folder.path() / "a");
        CAPTURE(name);
        CHECK(text::read_text_file(entry.path()) ==
              text::read_text_file(folder.path() / "b" / name));
    }
    CHECK(count == 8 + 5 * 5);  // five figures as .gp, .dat, .svg, .pdf and .png
    CHECK_THAT(text::read_text_file(folder.path() / "a/report.html"),
               ContainsSubstring("Gravity survey observations") &&
                   ContainsSubstring("n = 16) has itself a standard error of 0.54 mGal") &&
                   ContainsSubstring("<svg"));
}

TEST_CASE("without a working gnuplot everything except the figures is written") {
    const auto [script, reason] = GENERATE(table<std::string, std::string>({
        {"", "figures are missing: gnuplot is not installed (not in PATH)"},
        {"echo 'no fonts' >&2; exit 5", "gnuplot failed: no fonts; 4 more such"},
    }));
    CAPTURE(reason);
    const test::TemporaryDirectory folder;
    folder.write("bin/other", "");
    if (!script.empty()) {
        const auto file = folder.write("bin/gnuplot", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    const Outcome outcome = run(folder, kTsukuba, "PATH=\"$PWD/bin\"");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors, StartsWith("a351-correct: ") && ContainsSubstring(reason));
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    for (const std::string name : {"occupations.csv", "result.json", "figures/day.gp"})
        CHECK(std::filesystem::exists(folder.path() / "result" / name));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "result/figures/day.svg"));
    CHECK_THAT(text::read_text_file(folder.path() / "result/report.html"),
               ContainsSubstring(reason) && ContainsSubstring("Repeated stations"));
}

TEST_CASE("the model paper prints its RMS before and after the drift step") {
    const test::TemporaryDirectory folder;
    const Outcome outcome = run(folder, kTsukuba + "--model paper --verbose");
    CHECK(outcome.status == 0);
    CHECK(outcome.output.find("2.01 mGal (in sample, before the drift step)") != std::string::npos);
    CHECK(outcome.output.find("RMS 2.62 mGal (in sample, n = 16)") != std::string::npos);
    const auto json = json_of(folder);
    CHECK(json["in_sample"]["rms_before_drift_mgal"].get<double>() == Approx(2.0084).margin(1e-4));
    CHECK(json["in_sample"]["rms_mgal"].get<double>() == Approx(2.6249).margin(1e-4));
}

TEST_CASE("a network with one datum reports its deviation from the other known references") {
    const test::TemporaryDirectory folder;
    const std::string arguments =
        kTsukuba + "--model network --datum No.0 --prior temperature_mgal_per_degc -29.274 0.001 ";
    const Outcome outcome = run(folder, arguments + "--verbose --out a");
    CHECK(outcome.status == 0);
    CHECK_THAT(
        outcome.output,
        ContainsSubstring("known but not held: 12, off by 2.635 mGal rms (not in sample)") &&
            ContainsSubstring("(redundancy below 0.1), a blunder there cannot be found: No.12") &&
            ContainsSubstring("global test: v'Wv = ") && ContainsSubstring("dof = 2"));
    const auto json = json_of(folder, "a");
    CHECK(json["network"]["dof"] == 2);
    CHECK(json["network"]["references_not_held"]["stations"] == 12);
    CHECK(json["network"]["rows"].size() == 19);
    CHECK(json["models"].back()["dof"] == 4);  // 19 readings, a datum, 2 priors; 14 + 4 unknowns
    CHECK_THAT(
        text::read_text_file(folder.path() / "a/report.html"),
        ContainsSubstring("readings in the fit: 16. Unknowns: 17, of which stations: 13 (1 held); "
                          "degrees of freedom: 2"));
    CHECK(run(folder, arguments + "--out b").status == 0);
    CHECK(text::read_text_file(folder.path() / "a/result.json") ==
          text::read_text_file(folder.path() / "b/result.json"));
}

TEST_CASE("bad usage ends with status 2 and one line on standard error, and nothing is written") {
    const test::TemporaryDirectory folder;
    folder.write("unknown.csv",
                 "site,occupation,time_utc,acceleration_mgal,temperature_degc\n"
                 "No.77,1,2020-01-01T00:00:00Z,981700,42.5\n");
    folder.write("open.csv",
                 "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nX,140,36,5,\n");
    folder.write("open_readings.csv",
                 "site,occupation,time_utc,acceleration_mgal,temperature_degc\n"
                 "X,1,2020-01-01T00:00:00Z,981700,42.5\n");
    folder.write("nan.csv",
                 "site,occupation,time_utc,acceleration_mgal,temperature_degc\n"
                 "No.0,1,2020-01-01T00:00:00Z,nan,42.5\n");
    folder.write("short.csv", "site,occupation,time_utc,acceleration_mgal\n");
    folder.write("key.toml", "[survey]\nbasis = 'No.0'\n");
    folder.write("data/metadata/station.xml", "");
    folder.write("sites.csv",
                 "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nNo.0,140,36,5,979860\n");
    folder.write("base.toml", "[survey]\nbase = 'No.9'\n");
    folder.write("day.toml", "[survey]\n");
    folder.write("few.csv", "a\n1\n2\n");
    std::string far = "a,b\n1,0\n2,0\n1,0\n";
    for (int i = 0; i < 5000; ++i) far += ",0\n";
    folder.write("far.csv", far);
    folder.write("inf.csv", "a,b\n1,1\n,inf\n");
    folder.write("back.csv",
                 "time,a\n2020-01-01T00:00:01Z,1\n2020-01-01T00:00:02Z,1\n"
                 "2020-01-01T00:00:01.5Z,1\n");
    folder.write("hole.csv", "time_s,a\n0.02,1\n0.04,1\n0.08,1\n");
    const std::string sites = "table --sites '" A351_GOLDEN "/tsukuba/sites.csv' --observations ";
    const auto [arguments, message] = GENERATE_COPY(table<std::string, std::string>({
        {"", "A subcommand is required"},
        {"table", "--sites is required"},
        {"history result", "history is unknown: survey with several survey files writes"},
        {sites + "unknown.csv", "unknown.csv:2: site = No.77: unknown"},
        {sites + "nan.csv", "nan.csv:2: acceleration_mgal = nan"},
        {sites + "short.csv", "short.csv"},
        {sites + "missing.csv", "missing.csv: cannot be read"},
        {kTsukuba + "--model kriging", "t-rate-drift"},
        {"survey day.toml --curve=slow", "--curve is unknown: the curve follows from the model"},
        {kTsukuba + "--robust-terms t", "--robust-terms is unknown: every model but paper"},
        {kTsukuba + "--tide tide.csv", "longman"},
        {kTsukuba + "--figures gif", "pdf,png"},
        {kTsukuba + "--model paper --base No.3", "drift step is refused"},
        {"table --sites open.csv --observations open_readings.csv --model network",
         "model = network: no datum"},
        {kTsukuba + "--out few.csv", "few.csv is not a folder; allowed: a folder"},
        {"survey day.toml --out few.csv/result", "few.csv is not a folder; allowed: a folder"},
        {"emd --input inf.csv --column a --output data", "--output = data: not a regular file"},
        {"emd --input few.csv --column a --output few.csv", "--output = few.csv: is the input"},
        {"smooth --cutoff 9 --input few.csv --column a --output ./few.csv", "is the input"},
        {"decimate --factor 10 --input few.csv --column a --output few.csv", "is the input"},
        {kTsukuba + "--datum-sd 0", "--datum-sd = 0: out of range"},
        {kTsukuba + "--prior beta 1 2", "--prior = beta: no such coefficient; allowed: temp"},
        {kTsukuba + "--prior time_mgal_per_h 1 0", "out of range; allowed: mean from"},
        {kTsukuba + "--delta2 116", "--delta2 = 116"},
        {"decimate --factor 10 --input few.csv --column a",
         "few.csv: a: 2 rows are too short; allowed: 92 or more"},
        {"decimate --factor 10 --input inf.csv --column b", "inf.csv:3: b = inf: not a finite"},
        {"decimate --factor 10 --input back.csv --column a --output result",
         "back.csv:4: time = 2020-01-01T00:00:01.5Z: not after the row before it"},
        {"decimate --factor 10 --input hole.csv --column a",
         "hole.csv:4: time_s = 0.08: 0.04 s after the row before it; allowed: equal steps"},
        {"decimate --factor 10 --input few.csv --column b", "column b is missing; there are: a"},
        {"decimate --factor 10 --input . --column a", "cannot be read"},
        {"decimate --factor 1 --input few.csv --column a", "--factor = 1"},
        {"smooth --cutoff 1 --input few.csv --column a", "--cutoff = 1: "},
        {"smooth --cutoff 10 --input few.csv --column a",
         "few.csv: a: 2 samples; allowed: 3 or more"},
        {"smooth --cutoff 200 --input far.csv --column a",
         "far.csv: a: too many samples are missing for --cutoff = 200"},
        {"survey key.toml", "key.toml:2: survey.basis"},
        {"survey base.toml", "base.toml:2: survey.base = 'No.9': no such site; allowed: No.0"},
        {"tide --latitude 91 --longitude 0 --height 0 --from 2020-01-01T00:00:00Z "
         "--to 2020-01-01T01:00:00Z --step 60",
         "--latitude = 91"},
        {"tide --latitude 1 --longitude 0 --height 0 --from yesterday "
         "--to 2020-01-01T01:00:00Z --step 60",
         "--from = yesterday"},
        {"tide --latitude 1 --longitude 0 --height 0 --from 2020-01-01T02:00:00Z "
         "--to 2020-01-01T01:00:00Z --step 60",
         "--to = 2020-01-01T01:00:00Z: before --from; allowed: 2020-01-01T02:00:00Z or later"},
        {"export data --channel BNZ --rate 50 --format csv --from 2020-01-01T02:00:00Z "
         "--to 2020-01-01T02:00:00Z --out grid.csv",
         "--to = 2020-01-01T02:00:00Z: not after --from"},
        {"record data --from 2020-01-01T02:00:00Z --to 2020-01-01T01:00:00Z",
         "--to = 2020-01-01T01:00:00Z; allowed: an instant after --from"},
        {"survey day.toml day.toml --out both", "survey.name = day: used by two days"},
    }));
    CAPTURE(arguments);
    const Outcome outcome = run(folder, arguments);
    check_refused(outcome, message);
    CHECK(outcome.output.empty());
    CHECK_FALSE(has_result(folder));
}

TEST_CASE("a tide read from a file gives the same result as the model that wrote the file") {
    const test::TemporaryDirectory folder;
    // Mean position of the calibration line, along which the tide differs by less than 0.0001 mGal.
    CHECK(run(folder,
              "tide --latitude 36.215 --longitude 140.1 --height 300 --from 2017-07-15T23:00:00Z "
              "--to 2017-07-16T10:00:00Z --step 600 --output tide.csv")
              .status == 0);
    CHECK(run(folder, kTsukuba + "--tide tide.csv --out file").status == 0);
    CHECK(run(folder, kTsukuba + "--tide direct --out direct").status == 0);
    const auto file = table_of(folder, "file/occupations.csv");
    const auto direct = table_of(folder, "direct/occupations.csv");
    REQUIRE(file.row_count() == 19);
    for (std::size_t row = 0; row < 19; ++row) {
        for (const char* const column : {"tide_mgal", "corrected_mgal"}) {
            CHECK(file.number(row, column) ==
                  Approx(direct.number(row, column)).epsilon(0).margin(0.0002));
        }
    }
    const auto json = json_of(folder, "file");
    CHECK(json["settings"]["tide"] == "tide.csv");
    CHECK(json["settings"]["delta2"].is_null());
    CHECK(json["inputs"][2]["role"] == "tide");
    std::string morning = text::read_text_file(folder.path() / "tide.csv");
    folder.write("morning.csv", morning.substr(0, morning.find("2017-07-16T05")));
    check_refused(run(folder, kTsukuba + "--tide morning.csv"),
                  "morning.csv: time = 2017-07-16T05:");
    CHECK_FALSE(has_result(folder));
}

TEST_CASE("an output that is no regular file is refused, and a full disk gives status 1") {
    const test::TemporaryDirectory folder;
    const std::string tide =
        "tide --latitude 40 --longitude 140 --height 0 --from 2015-04-23T00:00:00Z --to "
        "2015-04-23T01:00:00Z --step 1800";
    folder.write("s.csv", "value\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n");
    for (const std::string& step :
         {tide, std::string("smooth --input s.csv --column value --cutoff 4"),
          std::string("decimate --input s.csv --column value --factor 2 --stages 1")}) {
        const Outcome refused = run(folder, step + " --output .");
        CHECK(refused.status == 2);
        CHECK(refused.errors ==
              "a351-correct: --output = .: not a regular file; allowed: a file\n");
    }
    folder.write("stdout.txt", "");
    const Outcome full = run(folder, tide + " > /dev/full 2> stderr.txt #");
    CHECK(full.status == 1);
    CHECK_THAT(full.errors, StartsWith("a351-correct: standard output: cannot be written"));
}

TEST_CASE("help and version are written to standard output with status 0") {
    const test::TemporaryDirectory folder;
    CHECK(run(folder, "--version").output == "a351-correct " A351_VERSION "\n");
    const Outcome help = run(folder, "tide --help");
    CHECK(help.status == 0);
    CHECK(help.output.find("positive where gravity is larger") != std::string::npos);
    for (const std::string command : {"survey", "table", "decimate", "emd", "smooth"})
        CHECK(run(folder, command + " --help").status == 0);
}
