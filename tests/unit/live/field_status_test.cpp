#include "daemon/survey/field_status.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"
#include "tests/unit/live/live_samples.hpp"

using namespace a351::daemon::survey;

namespace a351::daemon::live {
namespace {

/// A fake recorder with 40 min of samples at 50 Hz, from its minute 0 on.
struct Field {
    /// @param is_lifted  from minute 30.5 to 31 the box is lifted and levelled to another 0.1 deg.
    explicit Field(bool is_lifted = false) {
        constexpr std::int64_t kLifted = 1830 * 50, kLevelled = 1860 * 50;
        for (std::int64_t i = 0; i < 40 * 60 * 50; ++i) {
            PlacedSample sample =
                placed(i, is_lifted && i >= kLifted ? 1800.0 : 100.0, 0.0, 980000.0);
            if (is_lifted && i >= kLifted && i < kLevelled && i % 8 < 4)
                sample.counts[2] += counts_of(20000.0);
            sample.counts[3] += static_cast<std::int32_t>(i % 7) - 3;
            live.take(sample);
        }
    }
    void plan_two() {
        occupations.use(two_sites(), {.planned = std::chrono::minutes(12), .planned_set_ups = 2});
    }
    FakeRecorder recorder;
    Occupations occupations{recorder, two_sites(), {}};
    Record live{kProfile, 50, {}};
};

TEST_CASE("a stay is complete only with its planned set-ups") {
    Field field;
    field.plan_two();
    (void)field.occupations.start("No.0", {}, minute(20));
    const auto plan_at = [&](int at) {
        return field_status(field.occupations, field.live, minute(at)).stay->plan;
    };
    CHECK(plan_at(25).left_s == 60.0);
    CHECK(plan_at(27).needs_next());
    const auto stopped = field.occupations.stop({}, minute(30));
    CHECK(stopped.message.english().ends_with(
        "; 1 of 2 planned set-ups; shorter than planned: 10.0 of 12 min"));
    (void)field.occupations.start("No.1", {}, minute(30));
    (void)field.occupations.setup(minute(34));
    // The first set-up was two minutes shorter than planned.
    CHECK(plan_at(39).left_s == 180.0);
    CHECK(plan_at(40).running == 2);
    CHECK_FALSE(plan_at(40).is_complete());
    CHECK(plan_at(42).is_complete());
    const auto whole = field_status(field.occupations, field.live, minute(40)).whole;
    CHECK(whole.set_ups == 2);
    CHECK(whole.value->value() == Approx(980000.005).epsilon(0.0).margin(0.06));
    CHECK(field.occupations.stop({}, minute(42)).message.english().find("planned") ==
          std::string::npos);
}

TEST_CASE("a lift is asked about after three minutes at rest, unless Next set-up was pressed") {
    Field field(true), pressed(true);
    (void)field.occupations.start("No.0", {}, minute(20));
    CHECK_FALSE(field_status(field.occupations, field.live, minute(33)).moved);
    const auto now = field_status(field.occupations, field.live, minute(36));
    REQUIRE(now.moved);
    CHECK(now.moved->is_set_up);
    CHECK(std::abs(seconds_between(now.moved->time, minute(30))) < 30.0);
    (void)pressed.occupations.start("No.0", {}, minute(20));
    (void)pressed.occupations.setup(minute(30));
    for (int at = 31; at <= 40; ++at)
        CHECK_FALSE(field_status(pressed.occupations, pressed.live, minute(at)).moved);
}

TEST_CASE("the plan at an earlier instant has the set-ups up to it") {
    Field field;
    field.plan_two();
    CHECK_FALSE(planned_stay(field.occupations, field.live, minute(25)));
    (void)field.occupations.start("No.0", {}, minute(20));
    (void)field.occupations.setup(minute(27));
    CHECK_FALSE(planned_stay(field.occupations, field.live, minute(19)));
    CHECK(planned_stay(field.occupations, field.live, minute(24))->plan.running == 1);
    CHECK(planned_stay(field.occupations, field.live, minute(24))->plan.left_s == 120.0);
    CHECK(planned_stay(field.occupations, field.live, minute(30))->plan.running == 2);
}

TEST_CASE("a placement test counts twenty set-ups of three minutes, also after a restart") {
    Field field;
    CHECK(field.occupations.start("No.0", {}, minute(20), 1).kind == Outcome::Kind::refused);
    CHECK(field.occupations.start("No.0", {}, minute(20), 101).kind == Outcome::Kind::refused);
    (void)field.occupations.start("No.0", {}, minute(20), 20);
    (void)field.occupations.setup(minute(23));
    const SetUpPlan plan = field_status(field.occupations, field.live, minute(25)).stay->plan;
    CHECK(plan.running == 2);
    CHECK(plan.planned == 20);
    CHECK(plan.left_s == 60.0);
    CHECK(field_status(field.occupations, field.live, minute(26)).stay->plan.needs_next());
    const Occupations restarted(field.recorder, two_sites(), field.recorder.log);
    CHECK(restarted.planned_set_ups() == 20);
    CHECK(restarted.planned() == std::chrono::hours(1));
    CHECK(field.occupations.stop({}, minute(30))
              .message.english()
              .ends_with("; 2 of 20 planned set-ups; shorter than planned: 10.0 of 60 min"));
    CHECK(field.occupations.planned() == std::chrono::minutes(10));
    CHECK(field.occupations.planned_set_ups() == 1);
}

TEST_CASE("a short stay and a repeated site are said at the stop and the start") {
    Field field;
    (void)field.occupations.start("No.0", {}, minute(1));
    const auto stopped = field.occupations.stop({}, minute(3));
    CHECK(stopped.message.english().ends_with("; shorter than planned: 2.0 of 10 min"));
    const auto again = field.occupations.start("No.0", {}, minute(4));
    CHECK(again.message.english().ends_with("; the site was occupied before: stay 2"));
    // A stop at the end of the countdown is as planned.
    const auto planned = field.occupations.stop({}, minute(14) - std::chrono::milliseconds(2900));
    CHECK(planned.kind == Outcome::Kind::done);
    CHECK(planned.message.english().find("shorter") == std::string::npos);
}

TEST_CASE("missing samples of the running set-up give a warning, those before it do not") {
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

TEST_CASE(
    "tilt is relative to the first set-up of the day, and shown while the box may be touched") {
    Field field;
    const auto at = [&](int now) {
        return field_status(field.occupations, field.live, minute(now));
    };
    CHECK(at(39).level_site.empty());
    (void)field.occupations.start("No.1", {}, minute(2));
    CHECK(at(5).level_site.empty());
    (void)field.occupations.stop({}, minute(12));
    const auto now = at(39);
    CHECK(now.level_site == "No.1");
    CHECK(now.level_utc == minute(2));
    REQUIRE(now.level);
    CHECK(now.level->is_within);
    CHECK(now.level->tilt_arcmin[0] == Approx(0.0).margin(0.01));
    field.plan_two();
    (void)field.occupations.start("No.0", {}, minute(20));
    CHECK_FALSE(at(20).level);
    CHECK_FALSE(at(25).level);
    CHECK(at(26).level);
}

events::Event event(const char* type, UtcTime utc) {
    return {type, utc, {}, {}, {{"site", "No.0"}}};
}

TEST_CASE("a survey day begins after the pause of the night, also if a stop was forgotten before") {
    const bool is_forgotten = GENERATE(false, true);
    FakeRecorder recorder;
    std::vector<events::Event> events;
    for (const int hour : {0, 3, 6, 14, 16}) {
        events.push_back(event("start", minute(60 * hour)));
        if (hour != 6 || !is_forgotten) events.push_back(event("stop", minute(60 * hour + 10)));
    }
    const Occupations occupations(recorder, {}, events);
    const auto day = survey_day(occupations, minute(60 * 17));
    REQUIRE(day.size() == 2);
    CHECK(day[0].set_ups.front().start == minute(60 * 14));
    CHECK(survey_day(occupations, minute(60 * 23)).empty());
}

TEST_CASE("a site of the day before does not count as repeated") {
    FakeRecorder recorder;
    recorder.last = minute(60 * 20);
    Occupations occupations(recorder, two_sites(),
                            {event("start", minute(0)), event("stop", minute(10))});
    (void)occupations.start("No.0", {}, minute(60 * 20));
    REQUIRE(occupations.running());
    REQUIRE(occupations.running()->number == 2);
}

TEST_CASE("sites are listed with the nearest first, and those without a position last") {
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
