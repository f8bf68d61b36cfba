#include "daemon/survey/site_list.hpp"

#include <filesystem>

#include "daemon/survey/occupations.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"
#include "tests/unit/files/failing_files.hpp"

namespace a351::daemon::survey {
namespace {

const std::string kHeader = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";

text::Site new_site(const std::string& name) {
    text::Site site;
    site.name = name;
    site.latitude = Degrees(36.25);
    site.longitude = Degrees(140.125);
    site.has_altitude = false;
    return site;
}

struct List {
    explicit List(const std::string& content) : file(directory.write("sites.csv", content)) {}
    [[nodiscard]] std::string content() const { return text::read_text_file(file); }
    std::vector<text::Site> append(const text::Site& site) {
        return append_site(files::posix_files(), file, site);
    }
    test::TemporaryDirectory directory;
    std::filesystem::path file;
};

TEST_CASE("a new site is one further row, and all other bytes of the list are kept") {
    const std::string old = kHeader + "A , 140,36,10,979800.10 \n\nB,140,36,,\n";
    List list(old);
    const auto sites = list.append(new_site("C d"));
    CHECK(list.content() == old + "C d,140.125,36.25,,\n");
    REQUIRE(sites.size() == 3);
    CHECK(sites[2].name == "C d");
    CHECK(sites[2].is_placed);
    CHECK_FALSE(sites[2].has_altitude);
    text::Site known = new_site("D");
    known.has_altitude = true;
    known.altitude = Metres(12.5);
    known.gravity = MilliGal(979801.123);
    (void)list.append(known);
    CHECK(list.content().ends_with("\nD,140.125,36.25,12.5,979801.123\n"));
}

TEST_CASE(
    "the row has the separator, the decimal sign, the columns and the line ends of its list") {
    const std::string old =
        "site;longitude_deg;latitude_deg;altitude_m;gravity_mgal\nA.1;140,5;36;10;\n;;;;\n";
    List list(old);
    CHECK(list.append(new_site("B.2")).size() == 2);
    CHECK(list.content() == old + "B.2;140,125;36,25;;\n");
    const std::string quoted = kHeader + "A,140,\"36,2\",10,\n";
    List commas(quoted);
    CHECK(commas.append(new_site("B;2")).size() == 2);
    CHECK(commas.content() == quoted + "B;2,\"140,125\",\"36,25\",,\n");
    List semicolons("site;longitude_deg;latitude_deg;altitude_m;gravity_mgal\nA;140;36;10;\n");
    CHECK(semicolons.append(new_site("B;2")).back().name == "B;2");
    List mixed(
        "\xEF\xBB\xBFgravity_mgal,remark,site,latitude_deg,longitude_deg,altitude_m\r\n"
        "979800,steps,A,36,140,10");  // without a line end
    const std::string before = mixed.content();
    (void)mixed.append(new_site("B"));
    CHECK(mixed.content() == before + "\r\n,,B,36.25,140.125,\r\n");
    List wide(std::string("\xFF\xFEs\0", 4));
    CHECK_THROWS_AS(wide.append(new_site("B")), InputError);
}

TEST_CASE("a site that cannot be added is refused with the reason, and the list stays as it is") {
    List list(kHeader + "A,140,36,10,979800\n");
    const std::string old = list.content();
    const auto trouble = [&](const text::Site& site) {
        std::string words;
        try {
            (void)list.append(site);
        } catch (const InputError& error) {
            words = error.what();
        }
        CHECK(list.content() == old);
        CHECK(words.find('\n') == std::string::npos);
        return words;
    };
    CHECK(trouble(new_site("A")) == "the site A is in the list already");
    CHECK(trouble(new_site("")) == "the name of the site is empty");
    CHECK_THAT(trouble(new_site("\x83\x65")), ContainsSubstring("not UTF-8"));
    CHECK_THAT(trouble(new_site("a,b")), ContainsSubstring("comma"));
    for (const char* name : {"a\nb", "a\x7f", "a\tb", "a\xC2\x9B"})
        CHECK_THAT(trouble(new_site(name)), ContainsSubstring("hidden character"));
    for (const char* name : {" a", "a ", "a\t"})
        CHECK_THAT(trouble(new_site(name)), ContainsSubstring("blank"));
    text::Site site = new_site("B");
    site.latitude = Degrees(90.5);
    CHECK(trouble(site) == "latitude_deg = 90.5: out of range; allowed: -90 to 90");
    site = new_site("B");
    site.longitude = Degrees(-181.0);
    CHECK_THAT(trouble(site), ContainsSubstring("longitude_deg"));
    site = new_site("B");
    site.has_altitude = true;
    site.altitude = Metres(9001.0);
    CHECK_THAT(trouble(site), ContainsSubstring("altitude_m"));
    site = new_site("B");
    site.gravity = MilliGal(9.8);
    CHECK_THAT(trouble(site), ContainsSubstring("allowed: 976000 to 984000"));
}

TEST_CASE("the list is read again before it is written, and a broken one is refused") {
    List list(kHeader + "A,140,36,10,979800\n");
    (void)list.append(new_site("B"));
    const std::string changed = list.content() + "E,140.5,36.5,1,\n";  // by a text editor
    list.directory.write("sites.csv", changed);
    CHECK(list.append(new_site("C")).size() == 4);
    CHECK(list.content().starts_with(changed));
    list.directory.write("sites.csv", kHeader + "A,north,36,10,979800\n");
    CHECK_THROWS_WITH(list.append(new_site("D")), ContainsSubstring("sites.csv:2"));
}

TEST_CASE("a link to the list keeps pointing to it, and its permissions stay") {
    List list(kHeader + "A,140,36,10,979800\n");
    const auto link = list.directory.path() / "link.csv";
    std::filesystem::create_symlink("sites.csv", link);
    const auto permissions = std::filesystem::perms(0664);
    std::filesystem::permissions(list.file, permissions);
    (void)append_site(files::posix_files(), link, new_site("B"));
    CHECK(std::filesystem::read_symlink(link) == "sites.csv");
    CHECK(std::filesystem::status(list.file).permissions() == permissions);
    CHECK(list.content().ends_with("B,140.125,36.25,,\n"));
}

TEST_CASE("when any file operation fails the list is the old one or the new one") {
    List list(kHeader + "A,140,36,10,979800\n");
    const std::string old = list.content();
    test::FailingFiles counting;
    (void)append_site(counting, list.file, new_site("B"));
    const std::string complete = list.content();
    REQUIRE(counting.operations() > 2);
    for (int n = 1; n <= counting.operations(); ++n) {
        list.directory.write("sites.csv", old);
        test::FailingFiles failing(n);
        CHECK_THROWS_AS(append_site(failing, list.file, new_site("B")), std::system_error);
        CHECK((list.content() == old || list.content() == complete));
    }
}

TEST_CASE("a new site is used at once, and a list that cannot be written names the remedy") {
    List list(kHeader + "No.1,140,36,10,979800\n");
    FakeRecorder recorder;
    Occupations occupations(recorder, text::read_sites(list.file), {}, {.sites_file = list.file});
    CHECK(occupations.start("No.2", {}, minute(1)).kind == Outcome::Kind::refused);
    const auto changes = occupations.changes();
    const auto added = occupations.add_site(new_site("No.2"));
    CHECK(added.kind == Outcome::Kind::done);
    CHECK(added.message == "added No.2: 2 sites in " + list.file.string());
    CHECK(occupations.changes() == changes + 1);
    CHECK(occupations.start("No.2", {}, minute(1)).kind == Outcome::Kind::done);
    CHECK(occupations.add_site(new_site("no 2"))
              .message.english()
              .ends_with("; a similar name is No.2"));
    std::filesystem::remove(list.file);
    const auto gone = occupations.add_site(new_site("No.3"));
    CHECK(gone.kind == Outcome::Kind::failed);
    CHECK_THAT(gone.message, ContainsSubstring("/var/lib/a351/sites"));
    Occupations free(recorder, {}, {});
    CHECK_THAT(free.add_site(new_site("X")).message, ContainsSubstring("set sites in [survey]"));
}

}  // namespace
}  // namespace a351::daemon::survey
