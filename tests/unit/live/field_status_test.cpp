#include "daemon/survey/field_status.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/daemon/fake_recorder.hpp"
#include "tests/unit/live/live_samples.hpp"

using namespace a351::daemon::survey;

namespace a351::daemon::live {
namespace {

/// A fake recorder with 40 min of samples at 50 Hz, from its minute 0 on.
struct Field {
    Field() {
        for (std::int64_t i = 0; i < 40 * 60 * 50; ++i) {
            PlacedSample sample = placed(i, 100.0, 0.0, 980000.0);
            sample.counts[3] += static_cast<std::int32_t>(i % 7) - 3;
            live.take(sample);
        }
    }
    FakeRecorder recorder;
    Occupations occupations{recorder, two_sites(), {}};
    Record live{kProfile, 50, {}};
};

TEST_CASE("a plan of several set-ups counts each one down", "[field]") {
    struct Case {
        int planned, running;
        double stay_s, set_up_s, left_s;
        bool proposes_next, may_stop;
    };
    constexpr double kLength_s = 720.0;
    for (const Case& one : {Case{2, 1, 230.0, 230.0, 130.0, false, false},
                            {2, 1, 360.0, 360.0, 0.0, true, false},
                            {2, 1, 900.0, 900.0, 0.0, true, false},
                            {2, 2, 400.0, 20.0, 340.0, false, false},
                            {2, 2, 750.0, 360.0, 0.0, false, true},
                            {2, 3, 700.0, 10.0, 20.0, false, false},
                            {2, 3, 800.0, 30.0, 0.0, false, true},
                            {3, 2, 500.0, 240.0, 0.0, true, false},
                            // One planned set-up: half time.
                            {1, 1, 350.0, 350.0, 370.0, false, false},
                            {1, 1, 360.0, 360.0, 360.0, true, false},
                            {1, 1, 720.0, 720.0, 0.0, true, true},
                            {1, 2, 400.0, 40.0, 320.0, false, false},
                            {1, 2, 720.0, 300.0, 0.0, false, true}}) {
        CAPTURE(one.planned, one.running, one.stay_s, one.set_up_s);
        const SetUpPlan plan =
            set_up_plan(one.planned, kLength_s, one.running, one.stay_s, one.set_up_s);
        CHECK(plan.left_s == one.left_s);
        CHECK(plan.proposes_next == one.proposes_next);
        CHECK(plan.may_stop == one.may_stop);
    }
}

TEST_CASE("a stay is good enough only with its planned set-ups", "[field]") {
    Field field;
    field.occupations.use(
        two_sites(),
        {.planned = std::chrono::minutes(12), .planned_set_ups = 2, .target = MilliGal(5.0)});
    (void)field.occupations.start("No.0", {}, minute(20));
    auto now = field_status(field.occupations, field.live, minute(27));
    CHECK(now.reading->is_good_enough);
    CHECK_FALSE(now.whole.is_good_enough);
    CHECK_FALSE(now.whole.needed_s);  // time alone does not help
    CHECK(now.plan.proposes_next);
    const auto stopped = field.occupations.stop({}, minute(30));
    CHECK(stopped.message.english().ends_with(
        "; 1 of 2 planned set-ups; shorter than planned: 10.0 of 12 min"));
    (void)field.occupations.start("No.1", {}, minute(30));
    (void)field.occupations.setup(minute(34));
    now = field_status(field.occupations, field.live, minute(40));
    CHECK(now.whole.is_good_enough);
    CHECK(now.whole.set_ups == 2);
    CHECK(now.plan.running == 2);
    CHECK(now.plan.may_stop);
    CHECK(field.occupations.stop({}, minute(42)).message.english().find("planned") == std::string::npos);
}

TEST_CASE("a placement test counts twenty set-ups of three minutes, also after a restart",
          "[field]") {
    Field field;
    CHECK(field.occupations.start("No.0", {}, minute(20), 1).kind == Outcome::Kind::refused);
    CHECK(field.occupations.start("No.0", {}, minute(20), 101).kind == Outcome::Kind::refused);
    (void)field.occupations.start("No.0", {}, minute(20), 20);
    (void)field.occupations.setup(minute(23));
    const auto now = field_status(field.occupations, field.live, minute(25));
    CHECK(now.plan.running == 2);
    CHECK(now.plan.planned == 20);
    CHECK(now.plan.left_s == 60.0);
    CHECK_FALSE(now.plan.proposes_next);
    CHECK(field_status(field.occupations, field.live, minute(26)).plan.proposes_next);
    const Occupations restarted(field.recorder, two_sites(), field.recorder.log);
    CHECK(restarted.planned_set_ups() == 20);
    CHECK(restarted.planned() == std::chrono::hours(1));
    CHECK(field.occupations.stop({}, minute(30))
              .message.english()
              .ends_with("; 2 of 20 planned set-ups; shorter than planned: 10.0 of 60 min"));
    CHECK(field.occupations.planned() == std::chrono::minutes(10));
    CHECK(field.occupations.planned_set_ups() == 1);
}

TEST_CASE("a further set-up is proposed at half time, once only", "[field]") {
    Field field;
    CHECK_FALSE(field_status(field.occupations, field.live, minute(5)).reading);
    (void)field.occupations.start("No.0", {}, minute(20));
    auto now = field_status(field.occupations, field.live, minute(24));
    CHECK(now.plan.left_s == 360.0);
    CHECK_FALSE(now.plan.proposes_next);
    CHECK(now.warnings.empty());
    CHECK(field_status(field.occupations, field.live, minute(25)).plan.proposes_next);
    (void)field.occupations.setup(minute(26));
    now = field_status(field.occupations, field.live, minute(35));
    CHECK_FALSE(now.plan.proposes_next);
    CHECK(now.plan.may_stop);
    REQUIRE(now.reading->value);
    CHECK(now.reading->used_s == Approx(9.0 * 60.0 - 18.0).margin(2.0));
    CHECK(now.whole.value->value() == Approx(980000.005).epsilon(0.0).margin(0.06));
    CHECK(now.whole.standard_error->value() < now.reading->standard_error->value());
}

TEST_CASE("a forgotten stop and a repeated site give a warning", "[field]") {
    Field field;
    (void)field.occupations.start("No.0", {}, minute(1));
    CHECK(field_status(field.occupations, field.live, minute(30)).warnings.empty());
    const auto forgotten = field_status(field.occupations, field.live, minute(32)).warnings;
    REQUIRE(forgotten.size() == 1);
    CHECK(forgotten[0] == "running for 31 min, planned 10 min: stop it if the reading is finished");
    const auto stopped = field.occupations.stop({}, minute(3));
    CHECK(stopped.message.english().ends_with("; shorter than planned: 2.0 of 10 min"));
    const auto again = field.occupations.start("No.0", {}, minute(4));
    CHECK(again.message.english().ends_with("; the site was occupied before: stay 2"));
    (void)field.occupations.stop({}, minute(6));
    for (const int at : {7, 10}) {
        (void)field.occupations.start("No.1", {}, minute(at));
        CHECK(field_status(field.occupations, field.live, minute(at + 1)).warnings.size() ==
              (at == 7 ? 0U : 1U));
        (void)field.occupations.stop({}, minute(at + 2));
    }
}

TEST_CASE("a return to the first site of the day is no warning", "[field]") {
    Field field;
    (void)field.occupations.start("No.0", {}, minute(1));
    (void)field.occupations.stop({}, minute(3));
    (void)field.occupations.start("No.0", {}, minute(4));
    CHECK(field_status(field.occupations, field.live, minute(5)).warnings.empty());
}

TEST_CASE("missing samples of the running set-up give a warning, those before it do not",
          "[field]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    Record live{kProfile, 50, {}};
    const auto is_lost = [](std::int64_t second) {
        return (second >= 5 * 60 && second < 6 * 60) ||
               (second >= 12 * 60 && second < 12 * 60 + 90);
    };
    for (std::int64_t i = 0; i < std::int64_t{20} * 60 * 50; ++i)
        if (!is_lost(i / 50)) live.take(placed(i, 100.0, 0.0, 980000.0));
    CHECK(live.missing_s(minute(0), minute(20)) == Approx(150.0).margin(0.1));
    CHECK(live.missing_s(minute(7), minute(12)) == 0.0);
    CHECK(live.missing_s(minute(5) + std::chrono::seconds(30), minute(8)) ==
          Approx(30.0).margin(0.1));
    (void)occupations.start("No.0", {}, minute(10));
    const auto said = [&](int at) { return field_status(occupations, live, minute(at)).warnings; };
    CHECK(said(11).empty());
    CHECK(said(15) == std::vector<text::Message>{"90 s are missing in this set-up"});
    (void)occupations.setup(minute(14));
    CHECK(said(16).empty());
}

TEST_CASE("tilt is relative to the first set-up of the day", "[field][level]") {
    Field field;
    CHECK(field_status(field.occupations, field.live, minute(39)).level_site.empty());
    (void)field.occupations.start("No.1", {}, minute(2));
    CHECK(field_status(field.occupations, field.live, minute(39)).level_site == "No.1");
    (void)field.occupations.stop({}, minute(12));
    (void)field.occupations.start("No.0", {}, minute(20));
    const auto now = field_status(field.occupations, field.live, minute(39));
    CHECK(now.level_site == "No.1");
    CHECK(now.level_utc == minute(2));
    REQUIRE(now.level);
    CHECK(now.level->is_within);
    CHECK(now.level->tilt_arcmin[0] == Approx(0.0).margin(0.01));
}

events::Event event(const char* type, UtcTime utc) {
    events::Event event;
    event.type = type;
    event.utc = utc;
    event.details["site"] = "No.0";
    return event;
}

TEST_CASE("a survey day begins after the pause of the night", "[field]") {
    FakeRecorder recorder;
    std::vector<events::Event> events;
    for (const int hour : {0, 3, 6, 14, 16}) {
        events.push_back(event("start", minute(60 * hour)));
        events.push_back(event("stop", minute(60 * hour + 10)));
    }
    const Occupations occupations(recorder, {}, events);
    const auto day = survey_day(occupations, minute(60 * 17));
    REQUIRE(day.size() == 2);
    CHECK(day[0].set_ups.front().start == minute(60 * 14));
    CHECK(survey_day(occupations, minute(60 * 23)).empty());
}

TEST_CASE("a stop forgotten in the evening does not join two days", "[field]") {
    FakeRecorder recorder;
    const std::vector<events::Event> events{
        event("start", minute(0)), event("stop", minute(10)), event("start", minute(60)),
        event("start", minute(60 * 20)), event("stop", minute(60 * 20 + 10))};
    const Occupations occupations(recorder, {}, events);
    const auto day = survey_day(occupations, minute(60 * 21));
    REQUIRE(day.size() == 1);
    CHECK(day[0].set_ups.front().start == minute(60 * 20));
}

TEST_CASE("a site of the day before does not count as repeated", "[field]") {
    FakeRecorder recorder;
    recorder.last = minute(60 * 20);
    Occupations occupations(recorder, two_sites(),
                            {event("start", minute(0)), event("stop", minute(10))});
    const Record live{kProfile, 50, {}};
    (void)occupations.start("No.0", {}, minute(60 * 20));
    REQUIRE(occupations.running());
    REQUIRE(occupations.running()->number == 2);
    CHECK(field_status(occupations, live, minute(60 * 20 + 1)).warnings.empty());
}

TEST_CASE("the target is stored as an event and kept over a restart", "[field]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, {}, {}, {.target = MilliGal(0.7)});
    CHECK(occupations.target() == MilliGal(0.7));
    CHECK(occupations.set_target(MilliGal(0.35)).message ==
          "target set: good enough at a standard error of 0.35 mGal");
    for (const double wrong : {0.0, -1.0, 1e9, std::nan("")})
        CHECK(occupations.set_target(MilliGal(wrong)).kind == Outcome::Kind::refused);
    const Occupations again(recorder, {}, recorder.log);
    CHECK(again.target() == MilliGal(0.35));
    CHECK(recorder.log.size() == 1);
}

TEST_CASE("sites are listed with the nearest first, and those without a position last", "[field]") {
    std::vector<text::Site> sites(3);
    sites[0].name = "nowhere";
    sites[0].is_placed = false;
    sites[1].name = "far";
    sites[1].latitude = Degrees(37.0);
    sites[1].longitude = Degrees(140.0);
    sites[2].name = "near";
    sites[2].latitude = Degrees(36.1);
    sites[2].longitude = Degrees(140.0);
    const auto list = nearest_first(sites, Degrees(36.0), Degrees(140.0));
    CHECK(list[0].site.name == "near");
    CHECK(list[0].distance->value() ==
          Approx(11119.5).epsilon(0.0).margin(0.1));  // 0.1 deg on the sphere.
    CHECK(list[1].site.name == "far");
    CHECK_FALSE(list[2].distance);
}

}  // namespace
}  // namespace a351::daemon::live
