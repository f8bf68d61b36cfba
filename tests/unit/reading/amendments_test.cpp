#include "corrector/reading/amendments.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

const std::vector<text::Site> kAmendedSites{
    {"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)},
    {"B", Degrees(140.1), Degrees(36.1), Metres(20.0), std::nullopt}};

UtcTime at(const std::string& clock) { return parse_rfc3339("2020-01-01T" + clock + "Z").value(); }

/// Returns A (1) with two set-ups, B (1), A (2), and an occupation at an unknown site.
std::vector<OccupationWindow> list() {
    return {{{.site = "A", .occupation = 1}, at("00:00:00"), at("00:06:00")},
            {{.site = "A", .occupation = 1}, at("00:07:00"), at("00:13:00")},
            {{.site = "B", .occupation = 1, .is_flagged = true}, at("01:00:00"), at("01:12:00")},
            {{.site = "A", .occupation = 2}, at("02:00:00"), at("02:12:00")},
            {{.site = "BB", .occupation = 1}, at("03:00:00"), at("03:12:00")}};
}

std::vector<Amendment> amended(std::vector<OccupationWindow>& windows, const std::string& toml) {
    const test::TemporaryDirectory folder;
    std::vector<text::Site> sites = kAmendedSites;
    return amend(windows, folder.write("amendments.toml", toml), sites).list;
}

}  // namespace

TEST_CASE("amendments change occupations, add notes, and are reported with their reason") {
    auto windows = list();
    const auto amendments =
        amended(windows,
                "[[rename]]\nsite='BB'\noccupation=1\nto='B'\nreason='slip'\n"
                "[[exclude]]\nsite='A'\noccupation=1\nset_up=2\nreason='knock'\n"
                "[[include]]\nsite='B'\noccupation=1\nreason='was good'\n"
                "[[retime]]\nsite='A'\noccupation=2\n"
                "start_utc='2020-01-01T02:01:00Z'\nreason='started early'\n");
    CHECK_FALSE(windows[0].is_excluded);
    CHECK(windows[1].is_excluded);
    CHECK(windows[1].notes == std::vector<std::string>{"excluded"});
    CHECK_FALSE(windows[2].is_flagged);
    CHECK(windows[3].start == at("02:01:00"));
    CHECK(windows[3].end == at("02:12:00"));
    CHECK(windows[4].site == "B");
    CHECK(windows[4].occupation == 2);
    CHECK(amendments_text(amendments) ==
          "amended: exclude A (1), set-up 2: knock\n"
          "amended: include B (1): was good\n"
          "amended: retime A (2) to 2020-01-01T02:01:00Z - 2020-01-01T02:12:00Z: started early\n"
          "amended: rename BB (1) to B (2): slip\n");
    CHECK(
        amendments_json(amendments)[0].dump() ==
        R"({"kind":"exclude","site":"A","occupation":1,"set_up":2,"change":"","reason":"knock"})");
}

TEST_CASE("an amendment without a set-up applies to the whole stay") {
    auto windows = list();
    amended(windows,
            "[[exclude]]\nsite='A'\noccupation=1\nreason='r'\n"
            "[[rename]]\nsite='A'\noccupation=1\nto='B'\nreason='r'\n");
    for (const std::size_t i : {0U, 1U}) {
        CHECK(windows[i].is_excluded);
        CHECK(windows[i].site == "B");
        CHECK(windows[i].occupation == 2);
        CHECK(windows[i].notes == std::vector<std::string>{"excluded", "renamed"});
    }
}

TEST_CASE("amendments refer to the original list, so that two names can be exchanged") {
    auto windows = list();
    amended(windows,
            "[[rename]]\nsite='A'\noccupation=1\nto='B'\nreason='r'\n"
            "[[rename]]\nsite='B'\noccupation=1\nto='A'\nreason='r'\n");
    CHECK(windows[0].site == "B");
    CHECK(windows[0].occupation == 2);
    CHECK(windows[2].site == "A");
    CHECK(windows[2].occupation == 3);
}

TEST_CASE("set-ups, steps and references are amended") {
    const test::TemporaryDirectory folder;
    auto windows = list();
    auto sites = kAmendedSites;
    sites[1].u_gravity = MilliGal(0.01);
    const Amendments amendments = amend(
        windows,
        folder.write(
            "amendments.toml",
            "[[set_up]]\nsite='A'\noccupation=1\ntime_utc='2020-01-01T00:10:00Z'\nreason='r'\n"
            "[[set_up]]\nsite='A'\noccupation=1\ntime_utc='2020-01-01T00:09:00Z'\nreason='r'\n"
            "[[step]]\ntime_utc='2020-01-01T02:30:00Z'\nreason='fell'\n"
            "[[step]]\ntime_utc='2020-01-01T00:30:00Z'\nreason='knock'\n"
            "[[reference]]\nsite='A'\nuse=false\nreason='rebuilt'\n"
            "[[reference]]\nsite='B'\ngravity_mgal=979950.5\nreason='measured'\n"),
        sites);
    REQUIRE(windows.size() == 7);
    CHECK(windows[1].end == at("00:09:00"));
    CHECK(windows[2].start == at("00:09:00"));
    CHECK(windows[2].end == at("00:10:00"));
    CHECK(windows[3].start == at("00:10:00"));
    CHECK(windows[3].end == at("00:13:00"));
    CHECK(windows[3].occupation == 1);
    CHECK(amendments.steps == std::vector{at("00:30:00"), at("02:30:00")});
    CHECK(amendments.refused_references == std::vector<std::string>{"A"});
    CHECK(sites[1].gravity == MilliGal(979950.5));
    CHECK_FALSE(sites[1].u_gravity);  // It was that of the former value.
    CHECK(amendments_text(amendments.list) ==
          "amended: set_up A (1) at 2020-01-01T00:10:00Z: r\n"
          "amended: set_up A (1) at 2020-01-01T00:09:00Z: r\n"
          "amended: step at 2020-01-01T02:30:00Z: fell\n"
          "amended: step at 2020-01-01T00:30:00Z: knock\n"
          "amended: reference A not used: rebuilt\n"
          "amended: reference B to 979950.500 mGal: measured\n");
}

TEST_CASE("a bad amendment is refused with line, key and value") {
    const std::string one = "site='A'\noccupation=2\nreason='r'\n";
    const auto [toml, message] = GENERATE_COPY(table<std::string, std::string>({
        {"[[exclude]]\n" + one + "why='r'\n", "amendments.toml:5: exclude.why = 'r': unknown key"},
        {"[[remove]]\n" + one,
         "unknown key; allowed: exclude, include, reference, rename, retime, set_up, step"},
        {"[[exclude]]\nsite='A'\noccupation=2\n",
         "exclude.reason: missing; allowed: the reason, in words"},
        {"[[exclude]]\nsite='A'\nreason='r'\n", "exclude.occupation: missing"},
        {"[[exclude]]\nsite='C'\noccupation=1\nreason='r'\n",
         ":2: exclude.site = 'C': no occupation there; allowed: A, B, BB"},
        {"[[exclude]]\nsite='A'\noccupation=3\nreason='r'\n",
         ":3: exclude.occupation = 3: no such occupation of A; allowed: 1, 2"},
        {"[[exclude]]\nsite='A'\noccupation=1\nset_up=3\nreason='r'\n",
         "exclude.set_up = 3: no such set-up; allowed: 1 to 2"},
        {"[[exclude]]\n" + one + "[[include]]\n" + one,
         ":7: include.occupation = 2: contradicts another amendment of its use"},
        {"[[rename]]\n" + one + "to='C'\n", "rename.to = 'C': no such site; allowed: A, B"},
        {"[[rename]]\n" + one + "to='A'\n", "rename.to = 'A': already its name"},
        {"[[retime]]\n" + one, "retime.start_utc: missing"},
        {"[[retime]]\n" + one + "start_utc='noon'\n", "retime.start_utc = 'noon': not an instant"},
        {"[[retime]]\n" + one + "end_utc='2020-01-01T02:00:00Z'\n",
         "the end is not after the start"},
        {"[[retime]]\nsite='A'\noccupation=1\nreason='r'\nend_utc='2020-01-01T02:00:00Z'\n",
         "retime.set_up: missing; allowed: 1 to 2"},
        {"[[set_up]]\n" + one + "time_utc='2020-01-01T02:12:00Z'\n",
         "not within the stay; allowed: between 2020-01-01T02:00:00Z to 2020-01-01T02:12:00Z"},
        {"[[set_up]]\n" + one, "set_up.time_utc: missing; allowed: an instant"},
        {"[[step]]\ntime_utc='2020-01-01T02:12:00Z'\n", "step.reason: missing"},
        {"[[step]]\nsite='A'\ntime_utc='2020-01-01T02:12:00Z'\nreason='r'\n",
         "step.site = 'A': unknown key"},
        {"[[reference]]\nsite='C'\nuse=false\nreason='r'\n",
         "reference.site = 'C': no such site; allowed: A, B"},
        {"[[reference]]\nsite='A'\nreason='r'\n",
         "reference.gravity_mgal: missing; allowed: either gravity_mgal or use = false"},
        {"[[reference]]\nsite='A'\nuse=false\ngravity_mgal=979900\nreason='r'\n",
         "reference.use = false: contradiction"},
        {"[[reference]]\nsite='A'\ngravity_mgal=9.799\nreason='r'\n", "a number from 976000 to 984000"},
        {"[[reference]]\nsite='A'\nuse=false\nreason='r'\n"
         "[[reference]]\nsite='A'\ngravity_mgal=979900\nreason='r'\n",
         "contradicts another amendment of its reference"},
    }));
    CAPTURE(toml);
    auto windows = list();
    CHECK_THROWS_WITH(amended(windows, toml), ContainsSubstring(message));
    CHECK_THROWS_AS(amended(windows, toml), InputError);
}
