#include "daemon/live/live_record.hpp"

#include <string>
#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/miniseed.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/live/live_samples.hpp"

namespace a351::daemon::live {
namespace {

constexpr int kSecondsPerRecord = 2;

/// Writes 60 s of four channels, without z from `missing_from_s` to `missing_to_s`.
void write_archive(const std::filesystem::path& archive, const journal::StationCodes& codes,
                   int missing_from_s, int missing_to_s) {
    archive::Writer writer(files::posix_files(), archive, codes);
    for (int second = 0; second < 60; second += kSecondsPerRecord) {
        for (const std::string channel : {"BN1", "BN2", "BNZ", "BK1"}) {
            if (channel == "BNZ" && second >= missing_from_s && second < missing_to_s) continue;
            std::vector<std::int32_t> counts;
            for (int i = 50 * second; i < 50 * (second + kSecondsPerRecord); ++i)
                counts.push_back(channel == "BNZ" ? 16000000 + i : i);
            archive::RecordHeader header;
            header.network = codes.network;
            header.station = codes.station;
            header.location = codes.location;
            header.channel = channel;
            header.nominal_rate = Hertz(50.0);
            header.start = after(second);
            writer.record(channel, archive::pack_record(header, counts),
                          50 * (second + kSecondsPerRecord) - 1);
        }
    }
    static_cast<void>(writer.sync());
}

TEST_CASE("archived samples are loaded one by one, and gaps stay gaps") {
    const test::TemporaryDirectory directory;
    const journal::StationCodes codes;
    write_archive(directory.path(), codes, 20, 24);
    Record record(kProfile, 50, {});
    take_archived_past(directory.path(), codes, after(3600.0), record);
    CHECK(record.end() == 50 * 56);
    std::uint64_t cursor = 0;
    const auto before = record.block_from(cursor, 10000);
    REQUIRE(before);
    CHECK(before->first_time == kZero);
    CHECK(before->counts[2].size() == 1000);
    const auto behind = record.block_from(cursor, 10000);
    REQUIRE(behind);
    CHECK(behind->first_time == after(24.0));
    REQUIRE(behind->counts[2].size() == 1800);
    for (int i = 0; i < 1800; ++i) {
        CHECK(behind->counts[0][static_cast<std::size_t>(i)] == 1200 + i);
        CHECK(behind->counts[2][static_cast<std::size_t>(i)] == 16001200 + i);
    }
}

TEST_CASE("the last exchange of the sensor in the log is where the present one begins") {
    CHECK_FALSE(last_exchange({{"start", kZero, {}, {}, {}}}));
    CHECK(last_exchange({{"other_unit", kZero, {}, {}, {}},
                         {"other_unit", after(10.0), {}, {}, {}},
                         {"stop", after(20.0), {}, {}, {}}}) == after(10.0));
}

TEST_CASE("only the last day of the archive is loaded, and a missing archive gives no samples") {
    const test::TemporaryDirectory directory;
    const journal::StationCodes codes;
    write_archive(directory.path(), codes, 0, 0);
    Record late(kProfile, 50, {});
    take_archived_past(directory.path(), codes, after(24.0 * 3600.0 + 30.0), late);
    CHECK(late.end() == 50 * 30);
    Record none(kProfile, 50, {});
    take_archived_past(directory.path() / "nowhere", codes, after(60.0), none);
    CHECK(none.end() == 0);
}

}  // namespace
}  // namespace a351::daemon::live
