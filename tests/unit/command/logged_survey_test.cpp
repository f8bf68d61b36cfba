// A survey day whose event log has mistakes, corrected by the program: it reports them and computes
// the rest.
#include <array>
#include <fstream>
#include "tests/unit/command/run_command.hpp"
#include "tests/unit/reading/morning.hpp"

using namespace a351;

namespace {

events::Event start(std::size_t i) { return Morning::start_event(i); }
events::Event stop(std::size_t i) { return Morning::stop_event(i); }

/// Corrects a morning whose event log has these events in this order.
Outcome correct(const Morning& morning, const std::vector<events::Event>& events) {
    for (const events::Event& event : events) morning.log(event);
    morning.folder().write("day.toml", "[survey]\nmodel = 't'\n");
    return run(morning.folder(), "survey day.toml");
}

/// Returns "site (occupation) flags" of each row, with a star if it has no value.
std::vector<std::string> rows_of(const Morning& morning) {
    const auto table = table_of(morning.folder());
    std::vector<std::string> rows;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        rows.push_back(table.cell(row, "site") + " (" + table.cell(row, "occupation") + ") " +
                       table.cell(row, "flags"));
        if (table.cell(row, "corrected_mgal").empty()) rows.back() += '*';
    }
    return rows;
}

using Rows = std::vector<std::string>;

std::vector<events::Event> whole_morning() {
    std::vector<events::Event> events;
    for (std::size_t i = 0; i < Morning::kSites.size(); ++i) {
        events.push_back(start(i));
        events.push_back(stop(i));
    }
    return events;
}

}  // namespace

TEST_CASE("a stop logged before its start excludes that occupation, which keeps its number") {
    const Morning morning;
    auto late = start(0), early = stop(0);
    std::swap(late.utc, early.utc);
    const Outcome outcome =
        correct(morning, {late, early, start(1), stop(1), start(2), stop(2), start(3), stop(3)});
    CHECK(outcome.status == 0);
    CHECK_THAT(
        outcome.errors,
        ContainsSubstring("B (1) at 2020-05-01T23:52:50Z is left out: ends before it starts, "
                          "at 2020-05-01T23:50:20Z"));
    CHECK(rows_of(morning) == Rows{"B (1) ends-before-it-starts*", "S1 (1) ", "S2 (1) ", "B (2) "});
}

TEST_CASE(
    "a start before the stop of the previous occupation ends that one, with a warning and a flag") {
    const Morning morning;
    const Outcome outcome =
        correct(morning, {start(0), stop(0), start(1), start(2), stop(2), start(3), stop(3)});
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors,
               ContainsSubstring("S1 (1) at 2020-05-01T23:54:20Z has no stop: it "
                                 "lasts until the next start, at 2020-05-01T23:58:20Z"));
    CHECK_THAT(rows_of(morning)[1], StartsWith("S1 (1) no-stop"));
    CHECK_THAT(text::read_text_file(morning.folder().path() / "result/report.html"),
               ContainsSubstring("S1 (1) has no stop: it lasts until the next start"));
}

TEST_CASE("the order in which events were logged does not change the survey") {
    const Morning morning;
    const Outcome outcome = correct(
        morning, {start(3), stop(3), start(1), stop(1), start(0), stop(0), start(2), stop(2)});
    CHECK(outcome.status == 0);
    CHECK(outcome.errors.empty());
    CHECK(rows_of(morning) == Rows{"B (1) ", "S1 (1) ", "S2 (1) ", "B (2) "});
}

TEST_CASE("the last day of a recorder's log is corrected, unless another time is requested") {
    const Morning morning;
    std::vector<events::Event> events = whole_morning();
    for (std::size_t i = 0; i < 2; ++i) events[i].utc -= std::chrono::hours(24);
    const Outcome last = correct(morning, events);
    CHECK(last.status == 0);
    CHECK_THAT(last.errors,
               ContainsSubstring("from 2020-05-01T23:54:20Z on; occupations of earlier days: 1; "));
    CHECK(rows_of(morning) == Rows{"S1 (1) ", "S2 (1) ", "B (2) "});

    const Outcome timed = run(
        morning.folder(), "survey day.toml --from 2020-05-01T23:58:20Z --to 2020-05-02T00:02:21Z");
    CAPTURE(timed.errors);
    CHECK(timed.status == 0);
    CHECK(rows_of(morning) == Rows{"S2 (1) ", "B (2) "});
    morning.folder().write("day.toml",
                           "[survey]\nmodel = 't'\nfrom_utc = '2020-05-02T00:00:00Z'\n");
    const Outcome swapped = run(morning.folder(), "survey day.toml --to 2020-05-01T00:00:00Z");
    check_refused(swapped,
                  "day.toml: to_utc = 2020-05-01T00:00:00Z; allowed: an instant after "
                  "from_utc = 2020-05-02T00:00:00Z");
}

TEST_CASE("an option overrides the survey file, and the result records the setting that was used") {
    const Morning morning;
    morning.folder().write(
        "day.toml", "[survey]\noccupations = 'occupations.csv'\nmodel = 't'\ntrend = 'smoother'\n");
    for (const auto& [options, trend, curve] :
         std::vector<std::array<std::string, 3>>{{"", "smoother", "slow"},
                                                 {" --trend eemd", "eemd", "slow"},
                                                 {" --model paper", "eemd", "paper"}}) {
        CAPTURE(options);
        const Outcome outcome = run(morning.folder(), "survey day.toml" + options);
        CAPTURE(outcome.errors);
        REQUIRE(outcome.status == 0);
        const auto settings = json_of(morning.folder())["settings"];
        CHECK(settings["trend"] == trend);
        CHECK(settings["curve"] == curve);
        const auto table = table_of(morning.folder());
        CHECK(table.cell(0, "acceleration_mgal") == table.cell(0, trend + "_mgal"));
        CHECK(table.cell(0, "eemd_mgal") != table.cell(0, "smoother_mgal"));
    }
}

TEST_CASE(
    "a damaged archive record is reported with file and offset, and the day is still corrected") {
    const Morning morning;
    const auto file =
        morning.folder().path() / "data/archive/2020/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2020.122";
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(512 * 4)
        << std::string(512, '\0');
    const Outcome outcome = correct(morning, whole_morning());
    CAPTURE(outcome.errors);
    CHECK(outcome.status == 0);
    CHECK_THAT(
        outcome.errors,
        ContainsSubstring("XX.A351.00.BNZ.D.2020.122: offset 2048: 512 bytes are not a record"));
    const Rows rows = rows_of(morning);
    REQUIRE(rows.size() == 4);
    CHECK(Rows(rows.begin() + 1, rows.end()) == Rows{"S1 (1) ", "S2 (1) ", "B (2) "});
}
