#include "daemon/bundle/recorded_files.hpp"

#include "protocol/core/utc_time.hpp"
#include "tests/unit/journal/segment_fixture.hpp"

using namespace a351;
using namespace a351::daemon::bundle;

namespace {

const UtcTime kFrom = *parse_rfc3339("2026-03-01T12:00:00Z");

std::vector<std::string> names_of(const std::vector<RecordedFile>& files) {
    std::vector<std::string> names;
    for (const RecordedFile& file : files) names.push_back(file.name);
    return names;
}

std::string text_of(const journal::Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

TEST_CASE("the files of the days from an instant on are found, archive before journal") {
    const test::TemporaryDirectory root;
    const std::string segment = text_of(journal::segment_of(test::one_of_each()));
    for (const char* name : {"archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.059",
                             "archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.060",
                             "archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.061",
                             "archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.060.old"})
        root.write(name, std::string(512, 'r'));
    root.write("metadata/station.xml", "<xml/>");
    for (const char* name : {"events/2026-02.jsonl", "events/2026-03.jsonl", "events/notes.txt"})
        root.write(name, "{}\n");
    for (const char* name :
         {"00000001_20260301T100000Z.a351j.zst", "00000002_20260301T110000Z.a351j",
          "00000003_19700101T000000Z.a351j", "00000004_20260301T120000Z.a351j",
          "00000005_20260301T130000Z.a351j", "00000004_20260301T120000Z.torn"})
        root.write(std::string("journal/") + name, segment);
    root.write("state/lock", "x");
    std::filesystem::create_symlink("/etc/passwd", root.path() / "events/2026-04.jsonl");
    CHECK(names_of(recorded_files(root.path(), kFrom)) ==
          std::vector<std::string>{"archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.060",
                                   "archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.061",
                                   "metadata/station.xml", "events/2026-03.jsonl",
                                   "journal/00000003_19700101T000000Z.a351j",
                                   "journal/00000004_20260301T120000Z.a351j",
                                   "journal/00000005_20260301T130000Z.a351j"});
    CHECK(recorded_files(root.path() / "nothing", kFrom).empty());
}

TEST_CASE("of a file that is being appended only whole records, lines and chunks are taken") {
    const test::TemporaryDirectory root;
    const std::string segment = text_of(journal::segment_of(test::one_of_each()));
    const std::string log = std::string(5000, 'a') + "\n{}\n";
    for (const std::size_t torn :
         {std::size_t{0}, std::size_t{1}, std::size_t{12}, std::size_t{511}}) {
        root.write("archive/XX.2026.060", std::string(1024 + torn, 'r'));
        root.write("events/2026-03.jsonl", log + std::string(10 * torn, 'b'));
        root.write("journal/00000005_20260301T130000Z.a351j", segment + segment.substr(100, torn));
        const auto files = recorded_files(root.path(), kFrom);
        REQUIRE(files.size() == 3);
        CHECK(files[0].size == 1024);
        CHECK(files[1].size == log.size());
        CHECK(files[2].size == segment.size());
        CHECK(files[2].read(0, files[2].size) == segment);
    }
    root.write("archive/XX.2026.060", "torn");
    root.write("events/2026-03.jsonl", "torn");
    root.write("journal/00000005_20260301T130000Z.a351j", segment.substr(0, 10));
    CHECK(recorded_files(root.path(), kFrom).empty());
}

TEST_CASE("a segment that is compressed or removed meanwhile is still packed") {
    const test::TemporaryDirectory root;
    const auto file = root.write("journal/00000005_20260301T130000Z.a351j",
                                 text_of(journal::segment_of(test::one_of_each())));
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    const auto files = recorded_files(root.path(), kFrom);
    REQUIRE(files.size() == 1);
    const std::string before = files[0].read(0, files[0].size);
    std::filesystem::remove(file);
    CHECK(files[0].read(0, files[0].size) == before);
}

TEST_CASE("a folder or a pipe in place of a recorded file is refused") {
    const test::TemporaryDirectory root;
    std::filesystem::create_directories(root.path() / "metadata/station.xml");
    CHECK_THROWS_AS(recorded_files(root.path(), kFrom), std::system_error);
}
