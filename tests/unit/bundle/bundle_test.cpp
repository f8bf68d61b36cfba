#include "daemon/bundle/bundle.hpp"

#include "daemon/bundle/bundle_check.hpp"
#include "daemon/bundle/survey_day.hpp"
#include "daemon/bundle/tar.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon::bundle;

namespace {

UtcTime utc(const char* text) { return *parse_rfc3339(text); }

std::string all_of(Bundle& bundle) {
    std::string bytes;
    for (std::string piece = bundle.next(); !piece.empty(); piece = bundle.next()) bytes += piece;
    return bytes;
}

/// Returns the bundle of a root and two texts.
std::string bundle_of(const std::filesystem::path& root, UtcTime from) {
    Bundle bundle({.folder = "day",
                   .root = root,
                   .from = from,
                   .texts = {{"sites.csv", "site\nNo.1\n"}, {"empty.txt", ""}}});
    const std::uint64_t size = bundle.open();
    const std::string bytes = all_of(bundle);
    CHECK(bytes.size() == size);
    return bytes;
}

events::Occupation stay(const char* start) {
    events::Occupation one;
    one.set_ups = {{utc(start), utc(start) + std::chrono::minutes(10)}};
    return one;
}

}  // namespace

TEST_CASE("the header of a tar file is that of GNU tar") {
    // printf 'site\n' > a; touch -d @1772371536 a
    // tar --format=ustar --numeric-owner --owner=0 --group=0 --mode=644 -cf - a
    std::string expected(kTarBlock, '\0');
    const auto put = [&](std::size_t at, std::string_view text) {
        expected.replace(at, text.size(), text);
    };
    put(0, "a");
    put(100, "0000644");
    put(108, "0000000");
    put(116, "0000000");
    put(124, "00000000005");
    put(136, "15151037120");
    put(148, std::string_view("007375\0 ", 8));
    put(156, "0");
    put(257, std::string_view("ustar\00000", 8));
    put(329, "0000000");
    put(337, "0000000");
    const TarFile file{"a", 5, std::chrono::sys_seconds(std::chrono::seconds(1772371536))};
    CHECK(tar_header(file) == expected);
    CHECK(parse_tar_header(expected) == file);
    CHECK_THROWS_AS(tar_header({std::string(101, 'a'), 0}), std::invalid_argument);
    CHECK_THROWS_AS(tar_header({"a", std::uint64_t{1} << 33U}), std::invalid_argument);
}

TEST_CASE("a bundle has the texts and the recorded files with their checksums") {
    const test::TemporaryDirectory folder;
    folder.write("root/metadata/station.xml", std::string(300'000, 'x'));
    const std::string bytes = bundle_of(folder.path() / "root", utc("2026-03-01T00:00:00Z"));
    const auto file = folder.write("day.tar", bytes);
    CHECK(check_bundle(file) == 4);
    for (const char* name : {"day/sites.csv", "day/metadata/station.xml", "day/SHA256SUMS"})
        CHECK(bytes.find(name) != std::string::npos);
    // By the command sha256sum.
    CHECK(bytes.find("18e1371895cd3d663b62078ff7cf360ab158d0f4afee69745b05bb2e6ab053c7  "
                     "sites.csv\n") != std::string::npos);
    CHECK(bytes.find("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855  "
                     "empty.txt\n") != std::string::npos);
}

TEST_CASE("a changed or missing byte anywhere in a bundle is found") {
    const test::TemporaryDirectory folder;
    folder.write("root/metadata/station.xml", "<xml/>");
    const std::string bytes = bundle_of(folder.path() / "root", utc("2026-03-01T00:00:00Z"));
    const auto is_good = [&](const std::string& changed) {
        try {
            return check_bundle(folder.write("day.tar", changed)) > 0;
        } catch (const BadBundle&) {
            return false;
        }
    };
    REQUIRE(is_good(bytes));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        CAPTURE(i);
        REQUIRE_FALSE(is_good(changed));
    }
    for (std::size_t size = 0; size < bytes.size(); size += 100) {
        CAPTURE(size);
        REQUIRE_FALSE(is_good(bytes.substr(0, size)));
    }
    REQUIRE_FALSE(is_good(bytes + std::string(kTarBlock, '\0')));
    // Whole files that are absent: the first one, and the checksums.
    REQUIRE_FALSE(is_good(bytes.substr(2 * kTarBlock)));
    REQUIRE_FALSE(is_good(bytes.substr(0, bytes.size() - kTarEnd - 2 * kTarBlock) +
                          std::string(kTarEnd, '\0')));
}

TEST_CASE("a recorded file that is cut while it is packed ends the bundle") {
    const test::TemporaryDirectory folder;
    const auto xml = folder.write("root/metadata/station.xml", std::string(1'000'000, 'x'));
    Bundle bundle(
        {.folder = "day", .root = folder.path() / "root", .from = utc("2026-03-01T00:00:00Z")});
    CHECK(bundle.open() > 1'000'000);
    CHECK_FALSE(bundle.next().empty());
    std::filesystem::resize_file(xml, 100'000);
    CHECK_THROWS_AS(all_of(bundle), std::system_error);
}

TEST_CASE("a day begins twelve hours before the first stay after the last night") {
    SurveyDay day{.now = utc("2026-03-03T12:00:00Z")};
    CHECK(begin_of(day) == utc("2026-03-02T12:00:00Z"));
    day.stays = {stay("2026-03-01T01:00:00Z"), stay("2026-03-02T00:10:00Z"),
                 stay("2026-03-02T05:00:00Z")};
    CHECK(begin_of(day) == utc("2026-03-01T12:10:00Z"));
    day.running = utc("2026-03-02T10:00:00Z");
    CHECK(begin_of(day) == utc("2026-03-01T12:10:00Z"));
    day.running = utc("2026-03-03T09:00:00Z");
    CHECK(begin_of(day) == utc("2026-03-02T21:00:00Z"));
}

TEST_CASE("a bundle has a survey file for the files that there are") {
    const test::TemporaryDirectory folder;
    SurveyDay day{.root = folder.path(),
                  .station = "XX_A351",
                  .configuration = "[page]\n",
                  .gravity_so_far = "{}\n",
                  .now = utc("2026-03-01T12:34:56Z")};
    const auto survey_of = [&] {
        const Contents contents = contents_of(day);
        CHECK(contents.folder == "XX_A351_20260301T123456Z");
        for (const TextFile& text : contents.texts)
            if (text.name == "survey.toml") return text.content;
        return std::string();
    };
    CHECK(survey_of().empty());
    // The list of an operator may have any name and be a link.
    std::filesystem::create_symlink(folder.write("benchmarks of 2026.csv", "site\n"),
                                    folder.path() / "list.csv");
    day.sites = folder.path() / "list.csv";
    CHECK(survey_of() ==
          "# a351-correct survey takes this file, or its folder.\n[survey]\n"
          "name = \"XX_A351_20260301T123456Z\"\nroot = \".\"\nsites = \"sites.csv\"\n");
    day.calibration = folder.write("unit.toml", "");
    CHECK(survey_of().ends_with("sites = \"sites.csv\"\ncalibration = \"calibration.toml\"\n"));
    day.sites = folder.path() / "removed.csv";
    CHECK_THROWS_AS(contents_of(day), std::system_error);
}
