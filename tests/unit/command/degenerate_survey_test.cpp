// Survey days with missing or wrong input, corrected by the program: it computes the good part and
// reports the rest.
#include <boost/crc.hpp>
#include <map>
#include "tests/unit/command/run_command.hpp"
#include "tests/unit/reading/morning.hpp"

using namespace a351;

namespace {

const std::string kHeader = "site,occupation,start_utc,end_utc,used,note\n";
const std::string kB = "B,1,2020-05-01T23:50:20Z,2020-05-01T23:52:50Z,,\n";
const std::string kS1 = "S1,1,2020-05-01T23:54:20Z,2020-05-01T23:56:50Z,,\n";
const std::string kS2 = "S2,1,2020-05-01T23:58:20Z,2020-05-02T00:00:50Z,,\n";
const std::string kB2 = "B,2,2020-05-02T00:02:20Z,2020-05-02T00:04:50Z,,\n";

Outcome correct(const Morning& morning, const std::string& keys = "",
                const std::string& options = "") {
    morning.folder().write("day.toml", "[survey]\noccupations='occupations.csv'\n" + keys);
    return run(morning.folder(), "survey day.toml " + options);
}

void list(const Morning& morning, const std::string& rows) {
    morning.folder().write("occupations.csv", kHeader + rows);
}

/// Checks that the row has the value that was put in, to some hundredths of a mGal.
void check_value(const text::CsvTable& table, std::size_t row) {
    const UtcTime time = parse_rfc3339(table.cell(row, "time_utc")).value();
    CHECK(table.number(row, "acceleration_mgal") ==
          Approx(Morning::reading_mgal(seconds_between(Morning::kBegin, time)))
              .epsilon(0)
              .margin(0.05));
}

}  // namespace

TEST_CASE("an occupation without data stays in the table, and the others are computed") {
    const Morning morning;
    list(morning, kB + kS1 + kS2 + "S1,2,2020-05-02T00:01:00Z,2020-05-02T00:02:00Z,,\n" + kB2 +
                      "S2,2,2020-05-02T03:00:00Z,2020-05-02T03:10:00Z,,\n");
    const Outcome outcome = correct(morning);
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors,
               ContainsSubstring("S2 (2) at 2020-05-02T03:00:00Z is left out: no samples"));
    const auto table = table_of(morning.folder());
    REQUIRE(table.row_count() == 6);
    CHECK(table.cell(5, "site") == "S2");
    CHECK(table.cell(5, "time_utc").empty());
    CHECK(table.cell(5, "start_utc") == "2020-05-02T03:00:00.000Z");
    CHECK(table.cell(5, "used") == "0");
    CHECK(table.cell(5, "flags") == "no-samples");
    CHECK(table.cell(5, "corrected_mgal").empty());
    for (const std::size_t row : {0U, 1U, 2U, 4U}) check_value(table, row);
    CHECK_THAT(outcome.output, ContainsSubstring("S2 (2)"));
    const auto json = json_of(morning.folder());
    CHECK(json["occupations"].size() == 5);
    CHECK(json["left_out"].dump() ==
          R"([{"end_utc":"2020-05-02T03:10:00.000Z","occupation":2,"reason":"no samples",)"
          R"("site":"S2","start_utc":"2020-05-02T03:00:00.000Z"}])");
}

TEST_CASE("a day whose second half is missing is corrected from its first half") {
    const Morning morning;
    std::size_t removed = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(morning.folder().path() / "data/archive")) {
        if (!entry.path().string().ends_with(".2020.123")) continue;
        std::filesystem::remove(entry.path());
        ++removed;
    }
    REQUIRE(removed == 4);
    list(morning, kB + kS1 + kS2 + kB2);
    const Outcome outcome = correct(morning, "base='B'\n");
    CHECK(outcome.status == 0);
    const auto table = table_of(morning.folder());
    REQUIRE(table.row_count() == 4);
    for (const std::size_t row : {0U, 1U, 2U}) check_value(table, row);
    CHECK_THAT(table.cell(2, "flags"), ContainsSubstring("gap"));
    CHECK(table.cell(3, "flags") == "no-samples");
    CHECK(json_of(morning.folder())["in_sample"]["n"] == 3);
}

TEST_CASE("a lost base and a lost datum station are reported, and other stations replace them") {
    const Morning morning;
    list(morning, "B,1,2020-05-01T20:50:20Z,2020-05-01T20:52:50Z,,\n" + kS1 + kS2);
    const Outcome outcome = correct(morning, "base='B'\ndatum=['B','S1','S2']\nmodel='t'\n");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors, ContainsSubstring("base B has no occupation with a value") &&
                                   ContainsSubstring("datum B has no occupation with a value"));
    CHECK(json_of(morning.folder())["base"] == "S1");
    const Outcome paper = correct(morning, "base='B'\nmodel='paper'\n");
    check_refused(paper, "base = B: no occupation of this site");
}

TEST_CASE("the temperature file of the day before is listed among the inputs with its checksum") {
    const Morning morning;  // its archive has a file on each side of midnight
    list(morning, "S2,1,2020-05-02T00:01:05Z,2020-05-02T00:01:58Z,,\n" + kB2);
    REQUIRE(correct(morning, "model='t'\n").status == 0);
    std::map<std::string, std::uint32_t> checksums;
    const auto inputs = json_of(morning.folder())["inputs"];
    for (const auto& input : inputs)
        if (input["role"] == "archive") checksums[input["name"]] = input["crc32"];
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(morning.folder().path() / "data/archive")) {
        if (!entry.is_regular_file()) continue;
        const std::string name = entry.path().filename().string();
        CAPTURE(name);
        const bool is_read = name.ends_with(".123") || name == "XX.A351.00.BK1.D.2020.122";
        CHECK(checksums.contains(name) == is_read);
        if (!is_read) continue;
        ++count;
        boost::crc_32_type crc;
        const std::string content = text::read_text_file(entry.path());
        crc.process_bytes(content.data(), content.size());
        CHECK(checksums[name] == crc.checksum());
    }
    CHECK(count == 5);
}

TEST_CASE("one bad day of three is reported, and the others and the joint table are written") {
    const Morning morning;
    const auto& folder = morning.folder();
    folder.write("late.csv", kHeader + "B,1,2021-05-01T23:50:20Z,2021-05-01T23:52:50Z,,\n");
    folder.write("a.toml", "[survey]\noccupations='occupations.csv'\n");
    folder.write("b.toml", "[survey]\nname='bad'\noccupations='late.csv'\n");
    folder.write("c.toml", "[survey]\noccupations='occupations.csv'\nflags='ignore'\n");
    const Outcome outcome = run(folder, "survey a.toml b.toml c.toml");
    CHECK(outcome.status == 1);
    CHECK_THAT(outcome.errors,
               ContainsSubstring("1 of 3 surveys are not corrected, the others are written: "
                                 "bad: b.toml: root = ") &&
                   ContainsSubstring("no occupation has samples"));
    CHECK_THAT(outcome.output, ContainsSubstring("survey a\n") && ContainsSubstring("survey c\n") &&
                                   ContainsSubstring("all corrected days"));
    const auto result = folder.path() / "result";
    for (const std::string name : {"a", "c"})
        CHECK(std::filesystem::exists(result / name / "report.html"));
    CHECK_FALSE(std::filesystem::exists(result / "bad"));
    const auto joint = text::read_csv(result / "joint.csv");
    REQUIRE(joint.row_count() == 3);
    CHECK(joint.cell(0, "days") == "2");
    CHECK_THAT(text::read_text_file(result / "joint.html"),
               ContainsSubstring("Gravity of 3 surveys") &&
                   ContainsSubstring("<li>bad: b.toml: ") &&
                   ContainsSubstring("href=\"a/report.html\"") &&
                   ContainsSubstring("href=\"c/report.html\""));
    const Outcome none = run(folder, "survey b.toml --out none");
    CHECK(none.status == 2);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "none"));
}

TEST_CASE("swapped times and overlaps exclude only the occupations concerned") {
    const Morning morning;
    list(morning, kB + kS1 + kS2 + kB2 +
                      "S1,2,2020-05-02T00:01:50Z,2020-05-02T00:01:10Z,,\n"
                      "S2,2,2020-05-02T01:00:00Z,2020-05-02T01:10:00Z,,\n"
                      "S1,3,2020-05-02T01:05:00Z,2020-05-02T01:20:00Z,,\n");
    const Outcome outcome = correct(morning);
    CHECK(outcome.status == 0);
    const auto table = table_of(morning.folder());
    REQUIRE(table.row_count() == 7);
    for (const std::size_t row : {0U, 1U, 2U, 4U}) check_value(table, row);
    CHECK(table.cell(3, "flags") == "ends-before-it-starts");
    CHECK(table.cell(5, "flags") == "overlaps-another");
    CHECK(table.cell(6, "flags") == "overlaps-another");
    CHECK_THAT(
        outcome.errors,
        ContainsSubstring("S1 (2) at 2020-05-02T00:01:50Z is left out: ends before it starts, "
                          "at 2020-05-02T00:01:10Z"));
}

TEST_CASE("an amendment corrects swapped times without changing the data") {
    const Morning morning;
    list(morning, kB + "S1,1,2020-05-01T23:56:50Z,2020-05-01T23:54:20Z,,\n" + kS2 + kB2);
    morning.folder().write("amendments.toml",
                           "[[retime]]\nsite='S1'\noccupation=1\nstart_utc='2020-05-01T23:54:20Z'\n"
                           "end_utc='2020-05-01T23:56:50Z'\nreason='swapped in the field book'\n"
                           "[[exclude]]\nsite='S2'\noccupation=1\nreason='a lorry'\n");
    const std::string flags = GENERATE("use", "ignore");
    const Outcome outcome =
        correct(morning, "amendments='amendments.toml'\nflags='" + flags + "'\n");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.output, ContainsSubstring("amended: exclude S2 (1): a lorry\n") &&
                                   ContainsSubstring(": swapped in the field book\n"));
    const auto table = table_of(morning.folder());
    REQUIRE(table.row_count() == 4);
    check_value(table, 1);
    CHECK(table.cell(1, "flags") == "retimed");
    CHECK(table.cell(2, "flags") == "excluded");
    CHECK(table.cell(2, "used") == "0");
    CHECK(json_of(morning.folder())["settings"]["amendments"][0]["reason"] == "a lorry");
    CHECK(json_of(morning.folder())["inputs"][4]["role"] == "amendments");
}

TEST_CASE("a site without coordinates gets the tide of the mean position and is reported") {
    const Morning morning;
    correct(morning, "", "--out whole");
    morning.folder().write("sites.csv",
                           "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                           "B,,,,979800\nS1,140.0,36.1,200,979850\nS2,140.2,36.3,800,979760\n");
    const Outcome outcome = correct(morning);
    CHECK(outcome.status == 0);
    CHECK(outcome.errors ==
          "a351-correct: day: B: no position in the table of sites; the mean of the others is "
          "used\n");
    const auto table = table_of(morning.folder());
    const auto whole = table_of(morning.folder(), "whole/occupations.csv");
    for (std::size_t row = 0; row < 4; ++row)
        CHECK(table.number(row, "tide_mgal") ==
              Approx(whole.number(row, "tide_mgal")).epsilon(0).margin(0.0001));
    CHECK(json_of(morning.folder())["settings"]["warnings"].size() == 1);
}

TEST_CASE(
    "a survey with only one usable occupation is refused in one line that says why the "
    "others are left out") {
    const Morning morning;
    list(morning, kB + "S1,1,2020-05-02T03:00:00Z,2020-05-02T03:10:00Z,,\n");
    const Outcome outcome = correct(morning);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.errors, ContainsSubstring("day.toml: ") &&
                                   ContainsSubstring("at least 2 rows") &&
                                   ContainsSubstring("S1 (1) at 2020-05-02T03:00:00Z is left out"));
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(morning.folder().path() / "result"));
}

TEST_CASE("the tide of a survey can come from its occupations or from a file") {
    const Morning morning;
    morning.folder().write("occupations.csv",
                           "site,occupation,start_utc,end_utc,earth_tide_mgal\n"
                           "B,1,2020-05-01T23:50:20Z,2020-05-01T23:52:50Z,0.0125\n"
                           "S1,1,2020-05-01T23:54:20Z,2020-05-01T23:56:50Z,0.02\n"
                           "S2,1,2020-05-01T23:58:20Z,2020-05-02T00:00:50Z,0.03\n");
    CHECK(correct(morning, "tide='given'\n").status == 0);
    CHECK(table_of(morning.folder()).number(0, "tide_mgal") == 0.0125);
    morning.folder().write("tide.csv",
                           "time,tide_mgal\n2020-05-01T23:00:00Z,0.05\n2020-05-01T23:30:00Z,0.05\n"
                           "2020-05-02T00:00:00Z,0.05\n2020-05-02T00:30:00Z,0.05\n");
    CHECK(correct(morning, "tide='given'\n", "--tide tide.csv").status == 0);
    CHECK(table_of(morning.folder()).number(2, "tide_mgal") == 0.05);
    CHECK(json_of(morning.folder())["inputs"][4]["role"] == "tide");
    CHECK(correct(morning, "", "--tide none").status == 0);
    CHECK(table_of(morning.folder()).number(2, "tide_mgal") == 0.0);
}

TEST_CASE("a wrong input file of a survey gives status 2 and one line, and nothing is written") {
    const Morning morning;
    const auto& folder = morning.folder();
    folder.write("stray.toml", "[[exclude]]\nsite='S9'\noccupation=1\nreason='r'\n");
    folder.write("broken.toml", "[[exclude]\n");
    folder.write("short.csv",
                 "time,tide_mgal\n2020-05-01T23:00:00Z,0\n2020-05-01T23:10:00Z,0\n"
                 "2020-05-01T23:20:00Z,0\n2020-05-01T23:30:00Z,0\n");
    folder.write("bad-sites.csv",
                 "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                 "B,140.1,96.2,500,979800\n");
    const auto [keys, message] = GENERATE(table<std::string, std::string>({
        {"amendments='none.toml'\n", "none.toml: cannot be read"},
        {"amendments='stray.toml'\n", "stray.toml:2: exclude.site = 'S9': no occupation there"},
        {"amendments='broken.toml'\n", "broken.toml:1: not TOML"},
        {"tide='given'\n", "tide = given: B has no earth_tide_mgal; allowed: direct"},
        {"tide='absent.csv'\n",
         "day.toml:3: survey.tide = 'absent.csv': neither a source nor a file"},
        {"tide='short.csv'\n", "short.csv: time = 2020-05-01T23:51:"},
        {"sites='bad-sites.csv'\n", "bad-sites.csv:2: latitude_deg = 96.2: out of range"},
    }));
    CAPTURE(keys);
    const Outcome outcome = correct(morning, keys);
    check_refused(outcome, message);
    CHECK(outcome.output.empty());
    CHECK_FALSE(std::filesystem::exists(folder.path() / "result"));
}
