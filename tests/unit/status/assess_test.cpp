#include "daemon/status/status.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::source;
using namespace a351::daemon::status;

namespace {

Status healthy() {
    Status status;
    status.timing_state = timing::State::locked;
    return status;
}

}  // namespace

TEST_CASE("a sampling link with a good clock has the level good, and each trouble is named") {
    Status status = healthy();
    LinkStatus link;
    link.state = LinkStatus::State::sampling;
    link.device = wire::DeviceIdentity{"A351AU10", "00000042", 1, 0, true};
    fill(status, link);
    assess(status);
    CHECK(status.level == Status::Level::good);
    CHECK(status.reasons.empty());
    CHECK(status.serial_number == "00000042");

    status = healthy();
    link.waits_for_journal = true;
    fill(status, link);
    CHECK(status.level == Status::Level::warning);

    status = healthy();
    link = {};
    link.state = LinkStatus::State::searching;
    link.trouble = "/dev/x: not plugged in";
    fill(status, link);
    CHECK(status.level == Status::Level::fault);
    CHECK(status.reasons == std::vector<text::Message>{"no data: /dev/x: not plugged in"});

    status = healthy();
    status.timing_state = timing::State::unlocked;
    assess(status);
    CHECK(status.level == Status::Level::warning);
}

TEST_CASE("a sensor that had stopped, and another sensor, are warnings for an hour") {
    const UtcTime noon = *parse_rfc3339("2026-03-14T12:00:00Z");
    for (const bool is_other : {false, true}) {
        for (const int minutes : {-1, 0, 59, 60, 61}) {
            Status status = healthy();
            if (is_other)
                status.unit_change = UnitChange{noon, "00000001", std::string("0000\x01") + "777"};
            else
                status.started_again = noon;
            status.now = noon + std::chrono::minutes(minutes);
            assess(status);
            CAPTURE(is_other, minutes);
            REQUIRE(status.reasons.size() == (minutes == 0 || minutes == 59 ? 1 : 0));
            if (status.reasons.empty()) continue;
            CHECK(status.level == Status::Level::warning);
            CHECK_THAT(status.reasons[0].english(),
                       ContainsSubstring(is_other ? "2026-03-14T12:00:00Z: 0000?777 after 00000001"
                                                  : "the sensor had stopped"));
        }
    }
}

TEST_CASE("a start-up test that was not passed is named with its remedy, by seriousness") {
    LinkStatus link;
    link.state = LinkStatus::State::sampling;
    for (const auto& [result, level] :
         {std::pair(wire::StartUpTest::passed, Status::Level::good),
          std::pair(wire::StartUpTest::unknown, Status::Level::warning),
          std::pair(wire::StartUpTest::flash_error, Status::Level::fault),
          std::pair(wire::StartUpTest::hard_error, Status::Level::fault)}) {
        Status status = healthy();
        link.start_up_test = result;
        fill(status, link);
        CHECK(status.level == level);
        CHECK(status.start_up_test == wire::to_text(result));
        REQUIRE(status.reasons.size() == (level == Status::Level::good ? 0 : 1));
        if (level != Status::Level::good)
            CHECK_THAT(status.reasons[0].english(),
                       ContainsSubstring("start-up test") &&
                           ContainsSubstring("switch the sensor off and on"));
        if (result == wire::StartUpTest::flash_error)
            CHECK_THAT(status.reasons[0].english(),
                       ContainsSubstring("it may lack its calibration"));
        if (result == wire::StartUpTest::hard_error)
            CHECK_THAT(status.reasons[0].english(), ContainsSubstring("it is faulty"));
    }
}

TEST_CASE("another baud rate is reported of a sensor that answers only") {
    LinkStatus link;
    link.baud = 230400;
    link.configured_baud = 460800;
    for (const auto state : {LinkStatus::State::sampling, LinkStatus::State::waiting}) {
        Status status = healthy();
        link.state = state;
        fill(status, link);
        CHECK((status.reasons.back().english().find("230400 baud") != std::string::npos) ==
              (state == LinkStatus::State::sampling));
    }
}

TEST_CASE("samples from the future are a warning with the remedy") {
    Status status = healthy();
    status.now = *parse_rfc3339("2026-03-14T08:00:00Z");
    status.last_sample = status.now + std::chrono::seconds(4);
    assess(status);
    CHECK(status.reasons.empty());
    status.last_sample = status.now + std::chrono::seconds(847);
    assess(status);
    REQUIRE(status.reasons.size() == 1);
    CHECK_THAT(status.reasons[0].english(),
               ContainsSubstring("--clock") && ContainsSubstring("later than"));
    CHECK(status.level == Status::Level::warning);
}

TEST_CASE("a step of the clock is a warning for an hour, and an overlap is announced") {
    const UtcTime noon = *parse_rfc3339("2026-03-14T12:00:00Z");
    const ClockStep ahead{noon, noon + std::chrono::hours(1)};
    const auto assessed = [](const ClockStep& step, UtcTime now) {
        Status status = healthy();
        status.clock_step = step;
        status.now = now;
        assess(status);
        return status;
    };
    const Status within = assessed(ahead, ahead.after + std::chrono::minutes(59));
    REQUIRE(within.reasons.size() == 1);
    CHECK_THAT(within.reasons[0].english(),
               ContainsSubstring("set ahead by 3600.0 s, from 2026-03-14T12:00:00.0Z to "
                                 "2026-03-14T13:00:00.0Z") &&
                   !ContainsSubstring("twice"));
    CHECK(within.level == Status::Level::warning);
    CHECK(assessed(ahead, ahead.after + std::chrono::minutes(61)).reasons.empty());

    const Status back = assessed({noon, noon - std::chrono::seconds(80)}, noon);
    REQUIRE(back.reasons.size() == 1);
    CHECK_THAT(back.reasons[0].english(),
               ContainsSubstring("set back by 80.0 s") &&
                   ContainsSubstring("the times from 2026-03-14T11:58:40.0Z to "
                                     "2026-03-14T12:00:00.0Z occur twice"));
}

TEST_CASE("a clock that stays behind the recorded data is a warning until it is right") {
    Status status = healthy();
    const UtcTime noon = *parse_rfc3339("2026-03-14T12:00:00Z");
    status.clock_step = ClockStep{noon, noon - std::chrono::hours(20)};
    status.now = noon - std::chrono::hours(2);
    status.last_sample = noon;  // that of the last run
    Status right = status;
    Status passed = status;

    assess(status);
    REQUIRE(status.reasons.size() == 1);
    CHECK_THAT(status.reasons[0].english(),
               ContainsSubstring("set back by 72000.0 s") && ContainsSubstring("timedatectl"));
    right.is_host_synchronised = true;
    right.last_sample = right.now;
    assess(right);
    CHECK(right.reasons.empty());
    passed.now = noon;
    assess(passed);
    CHECK(passed.reasons.empty());
}

TEST_CASE("a clock that was never synchronised is one warning, however its uncertainty grows") {
    Status status = healthy();
    status.timing_uncertainty = std::chrono::seconds(14);
    assess(status);
    CHECK(status.reasons.empty());
    status.timing_uncertainty = std::chrono::milliseconds(16002);
    assess(status);
    REQUIRE(status.reasons.size() == 1);
    CHECK_THAT(status.reasons[0].english(), ContainsSubstring("never synchronised") &&
                                                ContainsSubstring("wrong by many seconds") &&
                                                ContainsSubstring("a351-correct retime"));
    Status later = healthy();
    later.timing_uncertainty = std::chrono::seconds(45);
    assess(later);
    CHECK(later.reasons == status.reasons);
    Status synchronised = healthy();  // The samples are uncertain for another reason.
    synchronised.is_host_synchronised = true;
    synchronised.timing_uncertainty = std::chrono::seconds(45);
    assess(synchronised);
    CHECK(synchronised.reasons.empty());
}

TEST_CASE("an oven that is not enabled is no trouble, an oven that does not answer is a warning") {
    OvenLinkStatus link;
    const auto reasons = [&link] {
        Status status = healthy();
        status.oven = link;
        assess(status);
        CHECK((status.level == Status::Level::warning) == !status.reasons.empty());
        return status.reasons;
    };
    using Reasons = std::vector<text::Message>;
    CHECK(reasons() == Reasons{"oven: searching: not asked yet"});

    link.state = OvenLinkStatus::State::answering;
    link.is_stale = false;
    link.values = oven::ControllerValues{DegC(42.5), DegC(42.5), Percent(25.0), 0x0100};
    CHECK(reasons().empty());
    link.values->status = oven::kInputError;
    CHECK(reasons() == Reasons{"oven: input error, its temperature is not valid; check the "
                               "controller's probe (sensor data are not affected)"});

    link.is_stale = true;
    CHECK(reasons() == Reasons{"oven: the last answer is old; check the controller's cable "
                               "(sensor data are not affected)"});
    link.state = OvenLinkStatus::State::silent;
    link.trouble = "no answer in time";
    CHECK(reasons() == Reasons{"oven: silent; check the controller's cable (sensor data are not "
                               "affected)"});
    Status status = healthy();
    status.outer_oven = OvenLinkStatus{};
    assess(status);
    CHECK(status.reasons == Reasons{"outer oven: searching: not asked yet"});
}

TEST_CASE("the polls of the oven are counted by their outcome") {
    OvenLinkStatus link;
    for (std::size_t i = 0; i < link.polls.size(); ++i) link.polls.at(i) = 10 + i;
    CHECK(polls_by_outcome(link) == std::map<std::string, std::uint64_t>{{"answered", 10},
                                                                         {"timed_out", 11},
                                                                         {"bad_crc", 12},
                                                                         {"exception", 13},
                                                                         {"other_unit", 14},
                                                                         {"malformed", 15},
                                                                         {"no_port", 16}});
}

TEST_CASE("a rate measured over a day is compared with the declared one") {
    const auto assessed = [](double measured_hz, double uncertainty_ppm, int hours,
                             std::optional<double> declared_hz = {}) {
        Status status = healthy();
        status.measured_rate = {Hertz(measured_hz), uncertainty_ppm, std::chrono::hours(hours)};
        status.declared_rate_hz = declared_hz;
        assess(status);
        return status;
    };
    const Status undeclared = assessed(50.0006, 0.05, 24);
    CHECK(undeclared.level == Status::Level::good);
    CHECK(undeclared.rate_advice ==
          "measured over a day: set declared_rate_hz = 50.000600 in [storage]");
    // Off by 0.24 ppm, of which 0.05 may be chance.
    const Status near = assessed(50.0006, 0.05, 24, 50.000612);
    CHECK(near.rate_advice.empty());
    CHECK(near.level == Status::Level::good);
    const Status off = assessed(50.0006, 0.05, 24, 50.000613);
    CHECK(off.level == Status::Level::warning);
    CHECK(off.rate_advice.english().find("-0.26 ppm") != std::string::npos);
    // The reason is the key of the log, so that it has no number that varies.
    CHECK(assessed(50.0005, 0.05, 24, 50.000613).reasons == off.reasons);

    CHECK(assessed(51.0, 0.05, 22).rate_advice.empty());  // Less than a day.
    CHECK(assessed(51.0, 0.21, 24).rate_advice.empty());  // Too uncertain.
    Status unmeasured = healthy();
    assess(unmeasured);
    CHECK(unmeasured.rate_advice.empty());
}

TEST_CASE("a clock that was not set is said once, however many records wait") {
    Status first = healthy(), later = healthy();
    first.counters.records_withheld = 4;
    later.counters.records_withheld = 20;
    assess(first);
    assess(later);
    CHECK(first.level == Status::Level::warning);
    CHECK(first.reasons == later.reasons);
}

TEST_CASE("the calibration of another unit is a warning") {
    Status status = healthy();
    status.calibrated_serial_number = "00000042";
    assess(status);
    CHECK(status.level == Status::Level::good);  // The sensor's number is not known yet.
    status.serial_number = "00000042";
    assess(status);
    CHECK(status.level == Status::Level::good);
    status.serial_number = "00000043";
    assess(status);
    CHECK(status.level == Status::Level::warning);
    CHECK(status.reasons.at(0) ==
          "the calibration is for unit 00000042, but the sensor is unit 00000043: the signal uses "
          "another unit's behaviour; check survey.calibration");
}

TEST_CASE("values of the sensor that are not believable are a fault") {
    Status status = healthy();
    status.sensor_troubles = {"the acceleration reads 0.50 g"};
    assess(status);
    CHECK(status.level == Status::Level::fault);
    CHECK(status.reasons == status.sensor_troubles);
}

TEST_CASE("a rate that is 2 % off is a fault in real time") {
    for (const bool is_in_real_time : {true, false}) {
        Status status = healthy();
        status.is_in_real_time = is_in_real_time;
        status.output_rate_hz = 50;
        status.wrong_rate = Hertz(51.0);
        assess(status);
        CHECK((status.level == Status::Level::fault) == is_in_real_time);
    }
}
