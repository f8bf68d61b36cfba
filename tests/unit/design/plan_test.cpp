#include "corrector/design/plan.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector::design;

namespace {

const std::string kHeader = "site,start_utc,set_ups,minutes_each\n";
const std::string kGood = "A,2026-05-01T00:00:00Z,1,12\nB,2026-05-01T09:30:00+09:00,2,6.5\n";

Plan read(const std::string& text) {
    const test::TemporaryDirectory folder;
    return read_plan(folder.write("plan.csv", text), made_up_sites());
}

std::string refusal_of(const std::string& text) {
    try {
        static_cast<void>(read(text));
    } catch (const InputError& error) {
        const std::string message = error.what();
        return message.substr(message.find("plan.csv"));
    }
    return "none";
}

}  // namespace

TEST_CASE("a plan is read with zones and parts of minutes") {
    const Plan plan = read(kHeader + kGood);
    REQUIRE(plan.size() == 2);
    CHECK(to_rfc3339(plan[1].start) == "2026-05-01T00:30:00Z");
    CHECK(plan[1].set_ups == 2);
    CHECK(to_rfc3339(plan[1].end()) == "2026-05-01T00:43:00Z");
    CHECK(duration_h(plan) == Approx(43.0 / 60.0));
}

TEST_CASE("a written plan is read as the same") {
    Plan plan = read(kHeader + kGood);
    plan[1].start += std::chrono::milliseconds(250);
    CHECK(read(plan_csv(plan)) == plan);
}

TEST_CASE("a plan of faces is read and written, and another one is refused") {
    const std::string header = "site,start_utc,set_ups,minutes_each,faces\n";
    const Plan plan =
        read(header + "A,2026-05-01T00:00:00Z,4,3,+--+\nB,2026-05-01T00:30:00Z,2,6,\n");
    CHECK(is_turned(plan));
    CHECK(plan[0].face(0) == 1.0);
    CHECK(plan[0].face(2) == -1.0);
    CHECK(plan[1].face(1) == 1.0);
    CHECK(read(plan_csv(plan)) == plan);
    CHECK(refusal_of(header + "A,2026-05-01T00:00:00Z,2,6,-+\n") ==
          "plan.csv:2: faces = -+: not a plan of faces; allowed: signs + and -, beginning with +, "
          "as +--+");
    CHECK(refusal_of(header + "A,2026-05-01T00:00:00Z,3,6,+-\n") ==
          "plan.csv:2: faces = +-: not one face for each of the set_ups; allowed: 3 signs, or + "
          "alone");
}

TEST_CASE("a mistake in a plan is one line with line, column, value and what is allowed") {
    const std::string first = "A,2026-05-01T00:00:00Z,1,12\n";
    CHECK(refusal_of(kHeader + first + "b ,2026-05-01T00:30:00Z,1,12\n") ==
          "plan.csv:3: site = b: unknown; allowed: a name of the table of sites; like B?");
    CHECK(refusal_of(kHeader + first + "Z,2026-05-01T00:30:00Z,1,12\n") ==
          "plan.csv:3: site = Z: unknown; allowed: a name of the table of sites");
    CHECK(refusal_of(kHeader + first + "B,,1,12\n") ==
          "plan.csv:3: start_utc = : not an instant; allowed: YYYY-MM-DDThh:mm:ss with zone");
    CHECK(refusal_of(kHeader + first + "B,2026-05-01T00:11:59Z,1,12\n") ==
          "plan.csv:3: start_utc = 2026-05-01T00:11:59Z: the visit of A is not over; allowed: "
          "2026-05-01T00:12:00Z or later");
    CHECK(refusal_of(kHeader + first + "B,2026-05-01T06:13:00Z,1,12\n") ==
          "plan.csv:3: start_utc = 2026-05-01T06:13:00Z: a long pause, which begins another survey "
          "day; allowed: at most 6 h after 2026-05-01T00:12:00Z");
    CHECK_THAT(refusal_of(kHeader + first + "B,2026-05-01T00:30:00Z,0,12\n"),
               ContainsSubstring("plan.csv:3: set_ups = 0: "));
    CHECK(refusal_of(kHeader + first + "B,2026-05-01T00:30:00Z,1.5,12\n") ==
          "plan.csv:3: set_ups = 1.5: not whole; allowed: a whole number, 1 to 30");
    CHECK_THAT(refusal_of(kHeader + first + "B,2026-05-01T00:30:00Z,1,1.9\n"),
               ContainsSubstring("plan.csv:3: minutes_each = 1.9: "));
    CHECK_THAT(refusal_of("site,start_utc,set_ups\n"), ContainsSubstring("plan.csv:"));
}

TEST_CASE("a plan visits a known and an unknown station") {
    CHECK_THAT(refusal_of(kHeader), ContainsSubstring("no site with a gravity_mgal"));
    CHECK_THAT(refusal_of(kHeader + "B,2026-05-01T00:00:00Z,1,12\n"),
               ContainsSubstring("no site with a gravity_mgal"));
    CHECK_THAT(refusal_of(kHeader + "A,2026-05-01T00:00:00Z,1,12\n"),
               ContainsSubstring("allowed: at least one without"));
}
