#include "daemon/survey/occupations.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/daemon/fake_recorder.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::survey;
using Kind = Outcome::Kind;

namespace {

bool mentions(const Outcome& outcome, const std::string& text) {
    CAPTURE(outcome.message);
    return outcome.message.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a change is committed with its sample before it is answered", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    REQUIRE(occupations.start("No.1", {"M. Ito", "windy"}, minute(10)).kind == Kind::done);
    REQUIRE(recorder.log.size() == 1);
    const auto& event = recorder.log.front();
    CHECK(event.type == "start");
    CHECK(event.utc == minute(10));
    CHECK(event.session == recorder.session);
    CHECK(event.index == 600);
    CHECK(event.details == std::map<std::string, std::string>{
                               {"site", "No.1"}, {"operator", "M. Ito"}, {"note", "windy"}});
    CHECK(occupations.stop({}, std::nullopt).kind == Kind::done);
    CHECK(recorder.log.back().type == "stop");
    CHECK(recorder.log.back().utc == *recorder.last);
}

TEST_CASE("a change that cannot be written to disk has no effect", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
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

TEST_CASE("replaying the log at any point leads to the same state", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations whole(recorder, two_sites(), {});
    const auto check_replay = [&] {
        const Occupations again(recorder, two_sites(), recorder.log);
        REQUIRE(again.running().has_value() == whole.running().has_value());
        if (whole.running()) {
            CHECK(again.running()->site == whole.running()->site);
            CHECK(again.running()->number == whole.running()->number);
            CHECK(again.running()->start == whole.running()->start);
            CHECK(again.running()->set_ups == whole.running()->set_ups);
            CHECK(again.running()->session == whole.running()->session);
            CHECK(again.running()->index == whole.running()->index);
            CHECK(again.running()->operator_name == whole.running()->operator_name);
        }
        CHECK(again.list().size() == whole.list().size());
    };
    whole.start("No.0", {"M. Ito", ""}, minute(1));
    check_replay();
    whole.setup(minute(5));
    check_replay();
    whole.note("a lorry passed");
    check_replay();
    whole.rename("No.1", {});
    check_replay();
    whole.stop({}, minute(12));
    check_replay();
    whole.start("No.1", {}, minute(20));
    check_replay();
    whole.discard();
    check_replay();
    whole.discard();
    check_replay();
    CHECK(recorder.log.size() == 8);
    CHECK(whole.list().empty());
}

TEST_CASE("stays at a site are counted without the discarded ones", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    occupations.start("No.0", {}, minute(1));
    CHECK(occupations.running()->number == 1);
    occupations.stop({}, minute(2));
    occupations.start("No.0", {}, minute(3));
    CHECK(occupations.running()->number == 2);
    occupations.discard();
    occupations.start("No.0", {}, minute(5));
    CHECK(occupations.running()->number == 2);
    occupations.stop({}, minute(6));
    const auto list = occupations.list();
    REQUIRE(list.size() == 2);
    CHECK(list[1].number == 2);
    CHECK(list[1].set_ups.front().start == minute(5));
    CHECK(list[1].set_ups.back().end == minute(6));
}

TEST_CASE("discard and rename apply to the running occupation, or else to the last one",
          "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    CHECK(occupations.discard().kind == Kind::refused);
    CHECK(occupations.rename("No.1", {}).kind == Kind::refused);
    occupations.start("No.0", {}, minute(1));
    occupations.stop({}, minute(2));
    CHECK(mentions(occupations.rename("No.1", {}), "No.0 (stay 1) to No.1"));
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list().front().site == "No.1");
    occupations.start("No.0", {}, minute(3));
    CHECK(occupations.rename("No.1", {}).kind == Kind::done);
    CHECK(occupations.running()->site == "No.1");
    CHECK(occupations.running()->number == 2);
    CHECK(mentions(occupations.discard(), "No.1 (stay 2), which was running"));
    CHECK(occupations.list().size() == 1);
    CHECK(mentions(occupations.discard(), "No.1 (stay 1)"));
    CHECK(occupations.list().empty());
    CHECK(occupations.discard().kind == Kind::refused);
}

TEST_CASE("a time outside the remembered record is refused", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    CHECK(mentions(occupations.start("No.0", {}, minute(61)), "later than the last sample"));
    CHECK(mentions(occupations.start("No.0", {}, minute(-1)), "earlier than"));
    recorder.last.reset();
    CHECK(mentions(occupations.start("No.0", {}, std::nullopt), "no sample"));
    CHECK(mentions(occupations.start("No.0", {}, minute(1)), "no sample"));
    CHECK(recorder.log.empty());
}

TEST_CASE("a missing site is refused, and an unknown one too if there is a list of sites",
          "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    CHECK(mentions(occupations.start("No.7", {}, minute(1)), "No.7 is not one of the 2"));
    CHECK(occupations.start("", {}, minute(1)).kind == Kind::refused);
    Occupations unlisted(recorder, {}, {});
    CHECK(unlisted.start("", {}, minute(1)).kind == Kind::refused);
    CHECK(unlisted.start("No.7", {}, minute(1)).kind == Kind::done);
    CHECK(unlisted.rename("", {}).kind == Kind::refused);
}

TEST_CASE("a second start is refused with the name and start of the running occupation",
          "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    occupations.start("No.0", {}, minute(1));
    const auto outcome = occupations.start("No.1", {}, minute(2));
    CHECK(outcome.kind == Kind::refused);
    CHECK(mentions(outcome, "No.0 (stay 1) has been running since 2026-03-14T08:01:00.0Z"));
    CHECK(recorder.log.size() == 1);
}

TEST_CASE("occupations do not overlap, but a forgotten one can be entered later",
          "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
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
}

TEST_CASE("stop and setup need a running occupation and a time after its last set-up",
          "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    CHECK(occupations.stop({}, minute(1)).kind == Kind::refused);
    CHECK(occupations.setup(minute(1)).kind == Kind::refused);
    occupations.start("No.0", {}, minute(10));
    CHECK(occupations.stop({}, minute(9)).kind == Kind::refused);
    CHECK(occupations.stop({}, minute(10)).kind == Kind::refused);
    CHECK(occupations.setup(minute(10)).kind == Kind::refused);
    CHECK(occupations.setup(minute(15)).kind == Kind::done);
    CHECK(occupations.stop({}, minute(15)).kind == Kind::refused);
    CHECK(occupations.stop({}, minute(16)).kind == Kind::done);
    REQUIRE(occupations.list().size() == 1);
    CHECK(occupations.list().front().set_ups.size() == 2);
}

TEST_CASE("notes and renames are possible while the sensor is unplugged", "[daemon][occupations]") {
    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    occupations.start("No.0", {}, minute(1));
    occupations.stop({}, minute(2));
    recorder.last.reset();
    CHECK(occupations.note("reading taken in the lee of the wall").kind == Kind::done);
    CHECK(recorder.log.back().utc == minute(2));
    CHECK_FALSE(recorder.log.back().index);
    CHECK(occupations.rename("No.1", {}).kind == Kind::done);
    CHECK(occupations.note("").kind == Kind::refused);
    Occupations empty(recorder, two_sites(), {});
    CHECK(empty.note("nothing to hold on to").kind == Kind::refused);
}
