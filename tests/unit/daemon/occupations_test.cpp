#include "daemon/survey/occupations.hpp"

#include <functional>
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::survey;
using Kind = Outcome::Kind;

namespace {

bool mentions(const Outcome& outcome, const std::string& text) {
    CAPTURE(outcome.message.english());
    return outcome.message.english().find(text) != std::string::npos;
}

struct Survey {
    FakeRecorder recorder;
    Occupations occupations{recorder, two_sites(), {}};
};

/// Names the stay that was entered for this minute.
Named of(int start_min) {
    std::string key = to_rfc3339(minute(start_min));
    std::erase_if(key, [](char c) { return c == '-' || c == ':'; });
    return {key, ""};
}

}  // namespace

TEST_CASE_METHOD(Survey, "a change is committed with its sample before it is answered") {
    REQUIRE(occupations.start("No.1", {"M. Ito", "windy"}, minute(10)).kind == Kind::done);
    REQUIRE(recorder.log.size() == 1);
    const auto& event = recorder.log.front();
    CHECK(event.type == "start");
    CHECK(event.utc == minute(10));
    CHECK(event.session == recorder.session);
    CHECK(event.index == 600);
    CHECK(event.details == std::map<std::string, std::string>{{"key", "20260314T081000Z"},
                                                              {"site", "No.1"},
                                                              {"operator", "M. Ito"},
                                                              {"note", "windy"}});
    CHECK(occupations.stop({}, std::nullopt).kind == Kind::done);
    CHECK(recorder.log.back().type == "stop");
    CHECK(recorder.log.back().utc == *recorder.last);
}

TEST_CASE_METHOD(Survey, "another sensor is logged once, in order, and ends the running stay") {
    REQUIRE(occupations.start("No.1", {}, minute(10)).kind == Kind::done);
    const auto changes = occupations.changes();
    events::Event exchange{"other_unit", minute(12), recorder.session, 720, {}};
    exchange.details = {{"before", "00000001"}, {"serial_number", "00000777"}};
    occupations.end_at_exchange(exchange);
    REQUIRE(recorder.log.size() == 2);
    CHECK(recorder.log.back().type == "other_unit");
    CHECK(occupations.changes() > changes);
    CHECK_FALSE(occupations.running());
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list()[0].set_ups.back().end == minute(12));

    SECTION("also if the clock was set back beyond the start of the stay") {
        recorder.last = minute(40);
        REQUIRE(occupations.start("No.0", {}, {}).kind == Kind::done);
        recorder.last = minute(50);
        exchange.utc = minute(-10);  // by the clock
        exchange.index = 3000;
        occupations.end_at_exchange(exchange);
        CHECK(recorder.log.back().utc == minute(50));
        CHECK_FALSE(occupations.running());
        const Occupations again(recorder, two_sites(), recorder.log);
        CHECK(again.list().back().set_ups.back().end == minute(50));
    }
}

TEST_CASE_METHOD(Survey, "a survey day ends six hours after the last begin of a set-up") {
    CHECK(occupations.day_end() == UtcTime::min());
    occupations.start("No.1", {}, minute(10));
    CHECK(occupations.day_end() == UtcTime::max());
    occupations.setup(minute(15));
    occupations.stop({}, minute(50));
    CHECK(occupations.day_end() == minute(15) + std::chrono::hours(6));
}

TEST_CASE_METHOD(Survey, "an order that was carried out already changes nothing") {
    const auto order = [&](auto&& twice) {
        REQUIRE(twice().kind == Kind::done);
        const auto events = recorder.log.size();
        const auto again = twice();
        CHECK(again.kind == Kind::done);
        CHECK(mentions(again, "as ordered before"));
        CHECK(recorder.log.size() == events);
    };
    order([&] { return occupations.start("No.1", {}, minute(10)); });
    CHECK(occupations.start("No.1", {}, minute(11)).kind == Kind::refused);
    CHECK(mentions(occupations.start("No.0", {}, minute(10)),
                   "No.1 (stay 1) has been running since 2026-03-14T08:10:00.0Z"));
    CHECK(occupations.start("No.1", {}, std::nullopt).kind == Kind::refused);
    order([&] { return occupations.setup(minute(15)); });
    CHECK(occupations.setup(minute(14)).kind == Kind::refused);
    order([&] { return occupations.stop({}, minute(20)); });
    CHECK(occupations.stop({}, minute(21)).kind == Kind::refused);
    CHECK(occupations.stop({}, std::nullopt).kind == Kind::refused);
    CHECK(occupations.list().size() == 1);
}

TEST_CASE_METHOD(Survey, "a change that cannot be written to disk has no effect") {
    recorder.is_disk_full = true;
    CHECK(occupations.start("No.1", {}, minute(10)).kind == Kind::failed);
    CHECK_FALSE(occupations.running());
    recorder.is_disk_full = false;
    REQUIRE(occupations.start("No.1", {}, minute(10)).kind == Kind::done);
    recorder.is_disk_full = true;
    CHECK(occupations.stop({}, minute(20)).kind == Kind::failed);
    CHECK(occupations.running());
    CHECK(occupations.list().empty());
}

TEST_CASE_METHOD(Survey, "replaying the log at any point leads to the same state") {
    const std::vector<std::function<void()>> orders{
        [&] {
            occupations.start("No.0", {"M. Ito", ""}, minute(1));
        },
        [&] { occupations.setup(minute(5)); },
        [&] { occupations.note({}, "a lorry passed"); },
        [&] { occupations.rename(of(1), "No.1", {}); },
        [&] { occupations.stop({}, minute(12)); },
        [&] { occupations.start("No.1", {}, minute(20)); },
        [&] { occupations.discard(of(20), {}); },
        [&] { occupations.retime(of(1), minute(2), minute(13), {}); },
        [&] { occupations.discard(of(1), {}); },
        [&] { occupations.restore(of(20), {}); }};
    for (const auto& order : orders) {
        order();
        const Occupations again(recorder, two_sites(), recorder.log);
        const auto expected = occupations.running(), found = again.running();
        REQUIRE(found.has_value() == expected.has_value());
        if (expected) {
            CHECK(found->site == expected->site);
            CHECK(found->number == expected->number);
            CHECK(found->start == expected->start);
            CHECK(found->set_ups == expected->set_ups);
            CHECK(found->session == expected->session);
            CHECK(found->index == expected->index);
            CHECK(found->operator_name == expected->operator_name);
        }
        CHECK(again.list().size() == occupations.list().size());
    }
    CHECK(recorder.log.size() == orders.size());
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list().front().key == of(20).key);
}

TEST_CASE_METHOD(Survey, "stays at a site are counted without the discarded ones") {
    occupations.start("No.0", {}, minute(1));
    CHECK(occupations.running()->number == 1);
    occupations.stop({}, minute(2));
    occupations.start("No.0", {}, minute(3));
    CHECK(occupations.running()->number == 2);
    occupations.discard(of(3), {});
    occupations.start("No.0", {}, minute(5));
    CHECK(occupations.running()->number == 2);
    occupations.stop({}, minute(6));
    const auto list = occupations.list();
    REQUIRE(list.size() == 2);
    CHECK(list[1].number == 2);
    CHECK(list[1].set_ups.front().start == minute(5));
    CHECK(list[1].set_ups.back().end == minute(6));
}

TEST_CASE_METHOD(Survey, "a change applies to the stay that its key names") {
    CHECK(mentions(occupations.discard(of(1), {}), "no stay has the key 20260314T080100Z"));
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    occupations.start("No.1", {}, minute(1));  // entered later, for an earlier time
    occupations.stop({}, minute(5));
    CHECK(mentions(occupations.rename(of(10), "No.1", {}), "renamed No.0 (stay 1), "));
    CHECK(occupations.list()[1].site == "No.1");
    CHECK(mentions(occupations.rename(of(10), "No.1", {}), "is at No.1 already"));
    occupations.start("No.0", {}, minute(30));
    CHECK(mentions(occupations.discard(of(1), {"", "", "wind"}), "discarded No.1 (stay 1), "));
    CHECK(recorder.log.back().details.at("reason") == "wind");
    CHECK(occupations.running()->key == of(30).key);
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list().front().key == of(10).key);
    CHECK(occupations.discarded().front().key == of(1).key);
    CHECK(mentions(occupations.discard(of(1), {}), "is discarded already"));
    CHECK(mentions(occupations.note(of(10), "lorry"), "for No.1 (stay 1), "));
    CHECK(occupations.list().front().note == "lorry");
    CHECK(mentions(occupations.restore(of(10), {}), "is not discarded"));
    CHECK(occupations.restore(of(1), {}).kind == Kind::done);
    CHECK(occupations.list().size() == 2);
    CHECK(mentions(occupations.discard(of(30), {}), "discarded No.0 (stay 1), running since"));
    CHECK_FALSE(occupations.running());
    CHECK(occupations.discarded().front().key == of(30).key);
}

TEST_CASE_METHOD(Survey, "a change is refused if the operator saw another site") {
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    Named stale{of(10).key, "No.1"};
    const auto events = recorder.log.size();
    for (const auto& outcome :
         {occupations.discard(stale, {}), occupations.restore(stale, {}),
          occupations.resume(stale, {}), occupations.retime(stale, minute(11), {}, {}),
          occupations.note(stale, "x")}) {
        CHECK(outcome.kind == Kind::refused);
        CHECK(mentions(outcome, "is at No.0, not at No.1"));
    }
    CHECK(recorder.log.size() == events);
    stale.site = "No.0";
    CHECK(occupations.discard(stale, {}).kind == Kind::done);
}

TEST_CASE_METHOD(Survey,
                 "the operator's answer that the box was not moved is an event of the stay") {
    CHECK(occupations.not_moved(of(10), {}).kind == Kind::refused);
    occupations.start("No.0", {}, minute(10));
    CHECK(mentions(occupations.not_moved(of(10), {.reason = "a hand"}), "No.0 (stay 1)"));
    CHECK(recorder.log.back().type == "not_moved");
    CHECK(recorder.log.back().details.at("key") == of(10).key);
    REQUIRE(occupations.running()->not_moved_until.has_value());
    const UtcTime until = *occupations.running()->not_moved_until;
    CHECK(until == recorder.log.back().utc);
    occupations.stop({}, minute(20));
    CHECK(occupations.list().front().not_moved_until == until);
    CHECK(mentions(occupations.not_moved({of(10).key, "No.1"}, {}), "not at No.1"));
    // A restarted daemon has the same answer.
    const Occupations restarted(recorder, two_sites(), recorder.log);
    CHECK(restarted.list().front().not_moved_until == until);
}

TEST_CASE_METHOD(Survey, "a stay is restored or moved only where no other stay is") {
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    occupations.discard(of(10), {});
    occupations.start("No.1", {}, minute(15));
    CHECK(mentions(occupations.restore(of(10), {}), "it would overlap No.1 (stay 1), running"));
    occupations.stop({}, minute(25));
    CHECK(mentions(occupations.restore(of(10), {}), "it would overlap No.1 (stay 1), 2026"));
    CHECK(mentions(occupations.retime(of(10), minute(9), {}, {}), "restore it first"));
    CHECK(occupations.retime(of(15), minute(20), minute(24), {}).kind == Kind::done);
    CHECK(occupations.restore(of(10), {}).kind == Kind::done);
    CHECK(mentions(occupations.retime(of(15), minute(19), {}, {}), "would overlap No.0"));
    CHECK(mentions(occupations.retime(of(15), minute(24), {}, {}), "is not before the end"));
    CHECK(mentions(occupations.retime(of(15), {}, minute(61), {}), "later than the last sample"));
    CHECK(mentions(occupations.retime(of(15), minute(20) - std::chrono::hours(25), {}, {}),
                   "is more than a day outside the stay"));
    CHECK(occupations.retime(of(15), {}, {}, {}).kind == Kind::refused);
    const auto moved = occupations.list().back();
    CHECK(moved.set_ups.front().start == minute(20));
    CHECK(moved.set_ups.back().end == minute(24));
    CHECK(moved.key == of(15).key);
}

TEST_CASE_METHOD(Survey,
                 "the answer to a start before finished stays says when its stop has to be") {
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    CHECK(mentions(
        occupations.start("No.1", {}, minute(5)),
        "No.0 (stay 1) began later, at 2026-03-14T08:10:00.0Z: give the stop a time before it"));
    occupations.stop({}, minute(8));
    CHECK_FALSE(mentions(occupations.start("No.1", {}, minute(30)), "later"));
}

TEST_CASE_METHOD(Survey, "the last stay is resumed within ten minutes of its stop") {
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    CHECK(mentions(occupations.resume(of(10), {}), "was stopped 40.0 min ago"));
    occupations.start("No.1", {}, minute(45));
    occupations.stop({}, minute(50));
    CHECK(occupations.resume(of(45), {}).kind == Kind::done);  // exactly ten minutes
    CHECK(occupations.running()->start == minute(45));
    CHECK(mentions(occupations.resume(of(10), {}), "No.1 (stay 1) has been running"));
    CHECK(mentions(occupations.retime(of(45), {}, minute(55), {}), "it has no end yet"));
    CHECK(occupations.retime(of(45), minute(46), {}, {}).kind == Kind::done);
    occupations.discard(of(45), {});
    CHECK(mentions(occupations.resume(of(45), {}), "restore it first"));
}

TEST_CASE_METHOD(Survey, "a time outside the remembered record is refused") {
    CHECK(mentions(occupations.start("No.0", {}, minute(61)), "later than the last sample"));
    CHECK(mentions(occupations.start("No.0", {}, minute(-1)), "earlier than"));
    recorder.last.reset();
    CHECK(mentions(occupations.start("No.0", {}, std::nullopt), "no sample"));
    CHECK(mentions(occupations.start("No.0", {}, minute(1)), "no sample"));
    CHECK(recorder.log.empty());
}

TEST_CASE_METHOD(Survey, "a start needs a site, and one of the list if there is a list") {
    CHECK(mentions(occupations.start("No.7", {}, minute(1)),
                   "No.7 is not one of the 2 sites that a351ctl sites lists"));
    CHECK(mentions(occupations.start("no 1", {}, minute(1)), "did you mean No.1?"));
    CHECK(occupations.start("", {}, minute(1)).kind == Kind::refused);
    Occupations unlisted(recorder, {}, {});
    CHECK(unlisted.start("", {}, minute(1)).kind == Kind::refused);
    CHECK(unlisted.start("No.7", {}, minute(1)).kind == Kind::done);
    CHECK(unlisted.rename(of(1), "", {}).kind == Kind::refused);
    // Wide characters become those of the list.
    CHECK(mentions(occupations.start("\uFF2E\uFF4F.0", {}, minute(1)), "started No.0"));
    CHECK(recorder.log.back().details.at("site") == "No.0");
    CHECK(occupations.rename(of(1), "No\uFF0E1", {}).kind == Kind::done);
    CHECK(recorder.log.back().details.at("site") == "No.1");
}

TEST_CASE_METHOD(Survey, "occupations do not overlap, but a forgotten one can be entered later") {
    occupations.start("No.0", {}, minute(10));
    occupations.stop({}, minute(20));
    CHECK(
        mentions(occupations.start("No.1", {}, minute(19)), "within the occupation No.0 (stay 1)"));
    CHECK(occupations.start("No.1", {}, minute(10)).kind == Kind::refused);
    CHECK(occupations.start("No.1", {}, minute(5)).kind == Kind::done);
    CHECK(mentions(occupations.stop({}, minute(11)), "No.0 (stay 1) lies between"));
    CHECK(occupations.stop({}, minute(10)).kind == Kind::done);
    CHECK(occupations.start("No.1", {}, minute(20)).kind == Kind::done);
    CHECK(occupations.running()->number == 2);
    occupations.stop({}, minute(30));
    // After a clock was set back, a stay can lie within another one.
    occupations.start("No.0", {}, minute(40));
    occupations.stop({}, minute(50));
    occupations.start("No.0", {}, minute(52));
    occupations.stop({}, minute(55));
    recorder.last = minute(45);
    CHECK(occupations.start("No.1", {}, {}).kind == Kind::done);
    recorder.last = minute(58);
    CHECK(occupations.stop({}, {}).kind == Kind::done);
    CHECK(occupations.list().size() == 6);
}

TEST_CASE_METHOD(Survey, "a stay keeps its own time when the clock is set back beyond its start") {
    recorder.last = minute(40);
    REQUIRE(occupations.start("No.1", {}, {}).kind == Kind::done);
    recorder.set_back = std::chrono::hours(1);
    CHECK(occupations.stop({}, {}).kind == Kind::refused);  // no signal since
    recorder.last = minute(40) + std::chrono::seconds(1);
    recorder.set_back = std::chrono::seconds(2);
    CHECK(occupations.stop({}, {}).kind == Kind::refused);  // times are uncertain by as much
    recorder.set_back = std::chrono::hours(1);
    recorder.last = minute(45);
    CHECK(mentions(occupations.setup({}), "the clock was set back during this stay"));
    CHECK(occupations.not_moved(of(40), {}).kind == Kind::done);
    CHECK(occupations.running()->not_moved_until == minute(45));
    recorder.last = minute(50);  // An order to several boxes has the time by the clock.
    CHECK(mentions(occupations.stop({}, minute(50 - 60)), "08:50:00"));
    REQUIRE(occupations.list().size() == 1);
    const auto set_ups = occupations.list().front().set_ups;
    REQUIRE(set_ups.size() == 2);
    CHECK(set_ups.back().start == minute(45));
    CHECK(set_ups.back().end == minute(50));
    CHECK(recorder.log.back().index == 3000);  // of the last sample, for a351-correct retime

    recorder.last = minute(55);
    CHECK(occupations.start("No.0", {}, {}).kind == Kind::done);
    CHECK(occupations.running()->start == minute(-5));
    recorder.last = minute(58);
    CHECK_FALSE(mentions(occupations.stop({}, {}), "the clock was set back"));
    CHECK(occupations.list().size() == 2);
}

TEST_CASE_METHOD(Survey,
                 "a clock that was set back and has caught up with a stay is said at its stop") {
    occupations.use(two_sites(), {.planned = std::chrono::minutes(20)});
    recorder.last = minute(10);
    REQUIRE(occupations.start("No.1", {}, {}).kind == Kind::done);
    recorder.set_back = std::chrono::minutes(15);
    recorder.last = minute(35);
    const Outcome stopped = occupations.stop({}, {});
    CHECK(mentions(stopped, "at 2026-03-14T08:20:00"));
    CHECK(mentions(stopped, "the clock was set back during this stay"));
    CHECK_FALSE(mentions(stopped, "shorter than planned"));
    CHECK(recorder.log.back().index == 35 * 60);
}

TEST_CASE_METHOD(Survey, "a further set-up without a sample does not keep a stay from its stop") {
    recorder.last = minute(10);
    REQUIRE(occupations.start("No.0", {}, {}).kind == Kind::done);
    CHECK(occupations.stop({}, {}).kind == Kind::refused);
    recorder.last = minute(20);
    REQUIRE(occupations.setup({}).kind == Kind::done);
    REQUIRE(occupations.stop({}, {}).kind == Kind::done);
    REQUIRE(occupations.list().back().set_ups.size() == 1);
    CHECK(occupations.list().back().set_ups.back().end == minute(20));
}

TEST_CASE_METHOD(Survey,
                 "stop and setup need a running occupation and a time after its last set-up") {
    CHECK(occupations.stop({}, minute(1)).kind == Kind::refused);
    CHECK(occupations.setup(minute(1)).kind == Kind::refused);
    occupations.start("No.0", {}, minute(10));
    CHECK(occupations.stop({}, minute(9)).kind == Kind::refused);
    CHECK(mentions(occupations.stop({}, minute(-5)),  // No data of it are in memory.
                   "is not after the start of the set-up at No.0, 2026-03-14T08:10:00.0Z"));
    CHECK(occupations.stop({}, minute(10)).kind == Kind::refused);
    CHECK(occupations.setup(minute(10)).kind == Kind::refused);
    CHECK(occupations.setup(minute(15)).kind == Kind::done);
    CHECK(occupations.stop({}, minute(15)).kind == Kind::refused);
    CHECK(occupations.stop({}, minute(16)).kind == Kind::done);
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list().front().set_ups.size() == 2);
}

TEST_CASE_METHOD(Survey, "notes and renames are possible while the sensor is unplugged") {
    occupations.start("No.0", {}, minute(1));
    occupations.stop({}, minute(2));
    recorder.last.reset();
    CHECK(occupations.note({}, "reading taken in the lee of the wall").kind == Kind::done);
    CHECK(recorder.log.back().utc == minute(2));
    CHECK_FALSE(recorder.log.back().index);
    CHECK(occupations.rename(of(1), "No.1", {}).kind == Kind::done);
    CHECK(occupations.note({}, "").kind == Kind::refused);
    Occupations empty(recorder, two_sites(), {});
    CHECK(empty.note({}, "nothing to hold on to").kind == Kind::refused);
}
