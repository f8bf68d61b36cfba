#include "protocol/archive/sds.hpp"

#include <fmt/core.h>

#include <cctype>
#include <chrono>
#include <system_error>
#include "tests/support/catch.hpp"

#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351::files;
using namespace a351::journal;

namespace a351::archive {
namespace {

namespace fs = std::filesystem;

UtcTime at(const char* time) { return *parse_rfc3339(time); }

PackedRecord record_at(const char* time, int sequence = 1) {
    RecordHeader header;
    header.network = "XX";
    header.station = "A351";
    header.location = "00";
    header.channel = "BNZ";
    header.sequence = sequence;
    header.start = at(time);
    header.nominal_rate = Hertz(50.0);
    return pack_record(header, std::vector<std::int32_t>(100, sequence));
}

fs::path day_file(const fs::path& archive, const char* time) {
    return sds_file(archive, StationCodes{}, "BNZ", at(time));
}

/// Returns the sequence numbers of the records in a file; all of it must decode.
std::vector<int> sequences_in(const fs::path& file) {
    std::vector<int> sequences;
    const auto bytes = test::read_bytes(file);
    REQUIRE(bytes.size() % kRecordSize == 0);
    for (std::size_t i = 0; i < bytes.size(); i += kRecordSize) {
        const auto decoded = decode_record(std::span(bytes).subspan(i, kRecordSize));
        REQUIRE(decoded);
        sequences.push_back(decoded->header.sequence);
    }
    return sequences;
}

}  // namespace

// The calendar is counted here day by day, and not taken from the library.
TEST_CASE("every day from 1970 to 2099 has its day file and reads back as the same day") {
    UtcTime midnight{};
    int days = 0;
    for (int year = 1970; year <= 2099; ++year) {
        const bool is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        const int in_year[] = {31, is_leap ? 29 : 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
        int of_year = 0;
        for (int month = 1; month <= 12; ++month) {
            for (int day = 1; day <= in_year[month - 1]; ++day, ++days) {
                const auto date = fmt::format("{:04}-{:02}-{:02}T00:00:00Z", year, month, day);
                const auto name = fmt::format(".{:04}.{:03}", year, ++of_year);
                REQUIRE(to_rfc3339(midnight, 0) == date);
                REQUIRE(parse_rfc3339(date) == midnight);
                const UtcTime next = midnight + std::chrono::hours(24);
                for (const UtcTime time : {midnight, next - Nanoseconds(1)})
                    REQUIRE(sds_file("", StationCodes{}, "BNZ", time).string().ends_with(name));
                midnight = next;
            }
        }
    }
    CHECK(days == 47'482);
}

TEST_CASE("a day file is named by the SDS rules") {
    StationCodes codes;
    CHECK(sds_file("archive", codes, "BNZ", at("2026-03-01T13:00:00Z")) ==
          "archive/2026/XX/A351/BNZ.D/XX.A351.00.BNZ.D.2026.060");
    codes.location = "";  // The dots remain.
    CHECK(sds_file("archive", codes, "LK1", at("2026-01-01T00:00:00Z")) ==
          "archive/2026/XX/A351/LK1.D/XX.A351..LK1.D.2026.001");
}

TEST_CASE("a record is written to the file of the day on which it starts, also of an earlier run") {
    const test::TemporaryDirectory directory;
    const auto archive = directory.path() / "archive";
    SdsWriter(posix_files(), archive, StationCodes{})
        .append("BNZ", record_at("2026-12-31T23:59:50Z", 1));
    SdsWriter writer(posix_files(), archive, StationCodes{});  // It continues the file.
    writer.append("BNZ", record_at("2026-12-31T23:59:52Z", 2));
    writer.append("BNZ",
                  record_at("2026-12-31T23:59:59.999999Z", 3));  // Reaches into the new year.
    writer.append("BNZ", record_at("2027-01-01T00:00:00Z", 4));
    writer.append("BNZ", record_at("2027-01-01T00:00:02Z", 5));
    writer.sync();
    CHECK(sequences_in(day_file(archive, "2026-12-31T00:00:00Z")) == std::vector{1, 2, 3});
    CHECK(sequences_in(day_file(archive, "2027-01-01T00:00:00Z")) == std::vector{4, 5});
    const auto days = day_files(archive, StationCodes{}, "BNZ");
    REQUIRE(days.size() == 2);
    CHECK(day_of(days[0]) == parse_rfc3339("2026-12-31T00:00:00Z"));
    CHECK(day_of(days[1]) == parse_rfc3339("2027-01-01T00:00:00Z"));
    const auto until = [&](const char* end) {
        return day_files(archive, StationCodes{}, "BNZ", UtcTime::min(), *parse_rfc3339(end));
    };
    CHECK(until("2026-12-31T00:00:00Z").empty());
    CHECK(until("2027-01-01T00:00:00Z").size() == 1);
    CHECK(until("2027-01-01T00:00:00.000001Z").size() == 2);
    CHECK(day_files(archive, StationCodes{}, "BNZ", day_of(days[1]), UtcTime::max()).size() == 1);
    CHECK(newest_day_file(archive, StationCodes{}, "BNZ") ==
          day_file(archive, "2027-01-01T00:00:00Z"));
}

TEST_CASE("the channels are those of this station that have a directory in any year") {
    const test::TemporaryDirectory directory;
    for (const char* path : {"2026/XX/A351/BNZ.D", "2026/XX/A351/BN1.D", "2027/XX/A351/BNZ.D",
                             "2027/XX/A351/LK1.D", "2027/XX/OTHER/LCE.D", "notes/XX/A351/BN2.D"}) {
        fs::create_directories(directory.path() / path);
    }
    CHECK(channels_in(directory.path(), StationCodes{}) ==
          std::vector<std::string>{"BN1", "BNZ", "LK1"});
    CHECK(channels_in(directory.path() / "absent", StationCodes{}).empty());
    CHECK_FALSE(newest_day_file(directory.path(), StationCodes{}, "BNZ"));
}

TEST_CASE("side files and files of other locations are not day files") {
    const test::TemporaryDirectory directory;
    const auto channel = directory.path() / "2026/XX/A351/BNZ.D";
    fs::create_directories(channel);
    for (const char* name : {"XX.A351.00.BNZ.D.2026.060", "XX.A351.00.BNZ.D.2026.061.512.torn",
                             "XX.A351.00.BNZ.D.2026.062.tmp", "XX.A351.10.BNZ.D.2026.063",
                             "XX.A351.00.BNZ.D.2026.06x"}) {
        test::write_bytes(channel / name, {});
    }
    CHECK(day_files(directory.path(), StationCodes{}, "BNZ") ==
          std::vector<fs::path>{channel / "XX.A351.00.BNZ.D.2026.060"});
}

TEST_CASE("a tail torn at any byte is cut back to whole records, and an empty file is removed") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "XX.A351.00.BNZ.D.2026.060";
    const auto side = directory.path() / "state";
    std::vector<std::byte> three;
    for (int i = 1; i <= 3; ++i) {
        const auto record = record_at("2026-03-01T12:00:00Z", i);
        three.insert(three.end(), record.bytes.begin(), record.bytes.end());
    }
    for (std::size_t size = 1; size <= three.size();
         size += (size % 512 < 2 || size % 512 > 509) ? 1u : 51u) {
        test::write_bytes(file, std::span(three).first(size));
        const auto tail = repair_tail(posix_files(), file, side);
        const std::size_t whole = size / kRecordSize * kRecordSize;
        REQUIRE(tail.has_value() == (whole != size));
        REQUIRE(fs::exists(file) == (whole > 0));
        if (!tail) continue;
        CHECK(tail->offset == whole);
        CHECK(tail->byte_count == size - whole);
        const auto name = file.filename().string() + "." + std::to_string(whole) + ".torn";
        CHECK(test::read_bytes(side / name).size() == size - whole);
        if (whole > 0) {
            REQUIRE(fs::file_size(file) == whole);
            CHECK_FALSE(repair_tail(posix_files(), file, side));
        }
    }
    test::write_bytes(file, {});
    REQUIRE(repair_tail(posix_files(), file, directory.path() / "none"));
    CHECK_FALSE(fs::exists(file));
    CHECK_FALSE(fs::exists(directory.path() / "none"));
}

TEST_CASE(
    "a hole behind the synced records is cut off, also if a set-back clock repeats their time") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "day";
    std::vector<std::byte> bytes;
    const auto append = [&](const char* start) {
        const auto record = record_at(start);
        bytes.insert(bytes.end(), record.bytes.begin(), record.bytes.end());
    };
    append("2026-03-01T12:00:00Z");
    append("2026-03-01T12:01:00Z");
    const auto newest_synced = decode_record(std::span(bytes).last(kRecordSize))->last_sample();
    bytes.resize(4 * kRecordSize);  // Zeros, as a file system may leave after a power cut.
    test::write_bytes(file, bytes);
    CHECK(repair_tail(posix_files(), file, directory.path() / "state").value().byte_count ==
          2 * kRecordSize);
    CHECK(fs::file_size(file) == 2 * kRecordSize);
    append("2026-03-01T12:00:30Z");
    test::write_bytes(file, bytes);
    const auto tail = repair_tail(posix_files(), file, directory.path() / "state", newest_synced);
    CHECK(tail.value().byte_count == 3 * kRecordSize);
    CHECK(fs::file_size(file) == 2 * kRecordSize);
}

TEST_CASE("nothing is copied from a damaged file to which a link in place of a day file leads") {
    const test::TemporaryDirectory directory;
    const auto root = directory.path() / "data", victim = directory.path() / "victim";
    const auto files = files::files_below(root);
    fs::create_directories(root / "archive");
    fs::create_directory(victim);
    const std::string secret(700, 'x');
    test::write_bytes(victim / "day", std::as_bytes(std::span(secret)));
    const bool is_folder = GENERATE(false, true);
    const auto folder = root / "archive" / "BNZ.D";
    if (is_folder) {
        fs::create_directory_symlink(victim, folder);
    } else {
        fs::create_directory(folder);
        fs::create_symlink(victim / "day", folder / "day");
    }
    CHECK_THROWS_WITH(repair_tail(*files, folder / "day", root / "state"),
                      (is_folder ? folder : folder / "day").string() +
                          " is a link; links in a data root are not followed");
    CHECK_FALSE(fs::exists(root / "state" / "day.0.torn"));
    CHECK(fs::file_size(victim / "day") == secret.size());
}

TEST_CASE("whichever file operation fails, readers find only whole records and writing continues") {
    int operations = 1000, strange = 0;
    const auto count_strange_files = [&strange](const fs::path& archive) {
        if (!fs::exists(archive)) return;
        for (const auto& entry : fs::recursive_directory_iterator(archive))
            strange += entry.is_regular_file() &&
                       std::isdigit(static_cast<unsigned char>(entry.path().string().back())) == 0;
    };
    for (int fail_at = 1; fail_at <= operations; ++fail_at) {
        const test::TemporaryDirectory directory;
        test::FailingFiles files(fail_at);
        const auto archive = directory.path() / "archive";
        SdsWriter writer(files, archive, StationCodes{});
        std::vector<int> written;
        const char* times[] = {"2026-03-01T23:59:50Z", "2026-03-01T23:59:55Z",
                               "2026-03-02T00:00:00Z", "2026-03-02T00:00:05Z"};
        for (int i = 0; i < 4; ++i) {
            // A record that failed is written again, as in recovery.
            for (bool is_done = false; !is_done;) {
                try {
                    writer.append("BNZ", record_at(times[i], i + 1));
                    is_done = true;
                    writer.sync();
                } catch (const std::system_error&) {
                    count_strange_files(archive);
                }
            }
        }
        operations = files.operations();
        std::vector<int> found;
        for (const auto& file : day_files(archive, StationCodes{}, "BNZ")) {
            CHECK(fs::file_size(file) > 0);
            for (const int sequence : sequences_in(file)) found.push_back(sequence);
        }
        CHECK(found == std::vector{1, 2, 3, 4});
    }
    CHECK(operations >= 10);
    CHECK(operations < 1000);
    CHECK(strange == 0);  // Only names that end in the day's number.
}

}  // namespace a351::archive
