#include "corrector/reading/stay_remarks.hpp"

#include <algorithm>

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace std::chrono_literals;

namespace {

const UtcTime kMorning = parse_rfc3339("2020-05-01T06:00:00Z").value();

/// Returns six stays of twelve minutes, one each half hour.
std::vector<OccupationWindow> day() {
    std::vector<OccupationWindow> windows;
    for (int k = 0; k < 6; ++k)
        windows.push_back({{std::string(1, static_cast<char>('A' + k))},
                           kMorning + k * 30min,
                           kMorning + k * 30min + 12min});
    return windows;
}

/// Returns three hours of samples, a record each minute.
archive::ChannelData record() {
    archive::Segment segment{50.0, std::vector<std::int32_t>(3 * 3600 * 50), {}};
    for (std::size_t minute = 0; minute < 180; ++minute)
        segment.anchors.push_back({minute * 3000, kMorning + minute * 1min});
    return {{std::move(segment)}, {}};
}

}  // namespace

TEST_CASE("nothing is said of a day of ordinary stays") {
    CHECK(stay_remarks(day(), record()).empty());
    CHECK(stay_remarks({}, {}).empty());
    auto brief = day();  // half as long as the others is not short from six minutes on
    brief[2].end = brief[2].start + 6min;
    CHECK(stay_remarks(brief, record()).empty());
}

TEST_CASE("a list of which most set-ups have no samples is named: its hours are doubtful") {
    CHECK_FALSE(mostly_without_samples(0, 0));
    CHECK_FALSE(mostly_without_samples(9, 18));
    const auto finding = mostly_without_samples(10, 19);
    REQUIRE(finding);
    CHECK(is_remark(*finding));
    CHECK(finding->text ==
          "10 of 19 set-ups have no samples: check when the sensor recorded, and date, hour and "
          "zone of the stays");
}

TEST_CASE("a stay without a stop is named, unless its move or an amendment ends it") {
    auto windows = day();
    windows[1].notes = {"no-stop"};
    windows[1].key = "20200501T063000Z";
    const auto findings = stay_remarks(windows, record());
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].kind == FindingKind::no_stop);
    CHECK(findings[0].key == "20200501T063000Z");
    CHECK(findings[0].text ==
          "B (1) has no stop: it lasts until the next start, at 2020-05-01T06:42:00Z");
    CHECK(is_remark(findings[0]));
    for (const char* const known : {"moved", "retimed", "excluded"}) {
        windows[1].notes = {"no-stop", known};
        CHECK(stay_remarks(windows, record()).empty());
    }
}

TEST_CASE("a stay much shorter than the others is named with both lengths") {
    auto windows = day();
    windows[3].end = windows[3].start + 4min;
    const auto findings = stay_remarks(windows, record());
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].kind == FindingKind::short_stay);
    CHECK(findings[0].site == "D");
    CHECK(findings[0].text ==
          "D (1) has 4.0 min, less than half the day's median of 12.0 min: its noise is averaged "
          "less");
    windows[3].is_last = true;  // it may still run
    CHECK(stay_remarks(windows, record()).empty());
    windows[3].is_last = false;
    windows.push_back({{"D"}, windows[3].end + 1min, windows[3].end + 5min});  // set-ups add up
    CHECK(stay_remarks(windows, record()).empty());
}

TEST_CASE("uncertain times and a clock that was set back are named") {
    auto uncertain = record();
    for (auto& anchor : uncertain.segments[0].anchors) {
        if (anchor.time >= kMorning + 1h) continue;
        anchor.is_time_questionable = true;
        anchor.timing_quality_percent = 20;
    }
    auto findings = stay_remarks(day(), uncertain);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].kind == FindingKind::clock);
    CHECK(findings[0].text ==
          "the times of 2 of 6 set-ups are uncertain by up to 10 s: the host's clock was not "
          "synchronised");
    for (auto& anchor : uncertain.segments[0].anchors)
        anchor.timing_quality_percent = std::max(anchor.timing_quality_percent, 40);
    CHECK(stay_remarks(day(), uncertain).empty());  // one second does not matter

    auto stepped = record();
    archive::Segment after{50.0, std::vector<std::int32_t>(3000), {{0, kMorning + 3h - 16s}}};
    stepped.segments.push_back(after);
    findings = stay_remarks(day(), stepped);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].code == "clock_set_back");
    CHECK(findings[0].text ==
          "the host's clock was set back by 16.0 s: two records are of 2020-05-01T08:59:44Z");
    stepped.segments[1].anchors[0].time = kMorning + 3h + 16s;  // missing samples
    CHECK(stay_remarks(day(), stepped).empty());
}

TEST_CASE("a face other than entered or planned is named, and the entered one counts more") {
    OccupationWindow window = day().front();
    CHECK_FALSE(other_face(window, -1));
    window.face.planned = 1;
    CHECK_FALSE(other_face(window, 1));
    const auto forgotten = other_face(window, -1);
    REQUIRE(forgotten);
    CHECK(forgotten->kind == FindingKind::turned);
    CHECK(forgotten->code == "turn_forgotten");
    CHECK_FALSE(is_remark(*forgotten));
    CHECK(forgotten->text ==
          "A (1): the set-up at 2020-05-01T06:00:00Z is in face -, but the plan asked for face +: "
          "a turn was forgotten; the reading is used as it is");
    window.face.entered = -1;
    CHECK_FALSE(other_face(window, -1));
    CHECK(other_face(window, 1)->code == "face_entered");
}
