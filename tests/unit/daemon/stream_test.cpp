#include <filesystem>
#include <fstream>
#include "daemon/stream/archive_streams.hpp"
#include "daemon/stream/datalink.hpp"
#include "daemon/stream/own_positions.hpp"
#include "daemon/stream/ring_connection.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon::stream;
using std::chrono::days;
using std::chrono::seconds;

namespace {

const UtcTime kNoon = *parse_rfc3339("2026-03-01T12:00:00Z");
const UtcTime kMidnight = *parse_rfc3339("2026-03-02T00:00:00Z");

/// Returns the mark of a record of 10 s.
Mark mark(int sequence, UtcTime start) { return {sequence, start, start + seconds(10)}; }

/// Archive in a directory of its own, of records with two samples, 10 s apart.
class Archive {
public:
    void append(int sequence, UtcTime start) {
        archive::RecordHeader header{.network = "XX",
                                     .station = "A351",
                                     .location = "00",
                                     .channel = "BNZ",
                                     .sequence = sequence,
                                     .start = start,
                                     .nominal_rate = Hertz(0.1),
                                     .declared_rate_hz = std::nullopt};
        const std::vector<std::int32_t> samples{sequence, sequence + 1};
        writer_.append("BNZ", archive::pack_record(header, samples));
    }
    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] std::filesystem::path day_of(UtcTime time) const {
        return archive::sds_file(root_, {}, "BNZ", time);
    }

private:
    test::TemporaryDirectory folder_;
    std::filesystem::path root_ = folder_.path() / "archive";
    archive::SdsWriter writer_{files::posix_files(), root_, {}};
};

/// Returns the sequence numbers of all records that follow `last`.
std::vector<int> sequences_after(const Archive& archive, std::optional<Mark> last,
                                 UtcTime from = UtcTime::min()) {
    ArchiveStreams streams(archive.root());
    streams.look({});
    for (const std::string& name : streams.unplaced()) streams.place(name, last, from);
    std::vector<int> sequences;
    while (const auto record = streams.next()) sequences.push_back(record->mark.sequence);
    return sequences;
}

}  // namespace

TEST_CASE("a record counts as sent by its number, or by its time after a power cut") {
    const Mark last = mark(100, kNoon);
    CHECK(is_sent(last, last, true));
    CHECK(is_sent(mark(99, kNoon - seconds(10)), last, true));
    CHECK_FALSE(is_sent(mark(101, kNoon + seconds(10)), last, true));
    CHECK(is_sent(mark(999'999, kNoon - seconds(20)), mark(1, kNoon), true));
    CHECK_FALSE(is_sent(mark(1, kNoon + seconds(10)), mark(999'999, kNoon), true));
    // Numbers 99 and 100 were lost in a power cut after they were sent; later samples have them again.
    CHECK_FALSE(is_sent(mark(99, kNoon + seconds(30)), last, true));
    // The clock was set back: an earlier time with a later number.
    CHECK_FALSE(is_sent(mark(101, kNoon - seconds(3600)), last, true));
    // It was set back over midnight: the records of the next day were sent before.
    CHECK(is_sent(mark(99, kNoon + days(1)), last, true));
    // The last record is not in the archive: it is another one, or a power cut took it.
    CHECK_FALSE(is_sent(mark(99, kNoon + days(1)), last, false));
    CHECK(is_sent(mark(99, kNoon - seconds(10)), last, false));
}

TEST_CASE("sending continues after the last record, whichever file it is in") {
    Archive archive;
    for (int i = 0; i < 4; ++i) archive.append(i + 1, kMidnight + seconds(20 * (i - 2)));
    CHECK(sequences_after(archive, std::nullopt) == std::vector{1, 2, 3, 4});
    CHECK(sequences_after(archive, mark(2, kMidnight - seconds(20))) == std::vector{3, 4});
    CHECK(sequences_after(archive, mark(4, kMidnight + seconds(20))).empty());
    CHECK(sequences_after(archive, std::nullopt, kMidnight - seconds(5)) == std::vector{3, 4});
    // A record of the ring that a power cut took from the archive.
    CHECK(sequences_after(archive, mark(5, kMidnight + seconds(40))).empty());
    archive.append(5, kMidnight + seconds(40));
    archive.append(6, kMidnight + seconds(300));
    CHECK(sequences_after(archive, mark(5, kMidnight + seconds(40))) == std::vector{6});
}

TEST_CASE("a new archive is sent although its numbers are those of the day before") {
    Archive archive;
    for (int i = 1; i <= 3; ++i) archive.append(i, kMidnight + seconds(20 * i));
    CHECK(sequences_after(archive, mark(5000, kNoon)) == std::vector{1, 2, 3});
    CHECK(sequences_after(archive, mark(5000, kNoon - days(1))) == std::vector{1, 2, 3});
}

TEST_CASE("numbers that a power cut took are sent with their new samples after midnight") {
    Archive archive;
    for (int i = 1; i <= 2; ++i) archive.append(i, kMidnight - seconds(100 - 20 * i));
    archive.append(3, kMidnight + seconds(20));
    archive.append(4, kMidnight + seconds(40));
    CHECK(sequences_after(archive, mark(4, kMidnight - seconds(20))) == std::vector{3, 4});
}

TEST_CASE("a cut of a day file leaves the records that were read before it") {
    Archive archive;
    for (int i = 1; i <= 10; ++i) archive.append(i, kNoon + seconds(20 * i));
    ArchiveStreams streams(archive.root());
    streams.look({});
    streams.place("XX_A351_00_BNZ", std::nullopt, UtcTime::min());
    CHECK(streams.next()->mark.sequence == 1);
    const auto file = archive.day_of(kNoon);
    std::filesystem::resize_file(file, 8 * 512);
    streams.look({});
    for (int i = 2; i <= 8; ++i) CHECK(streams.next()->mark.sequence == i);
    CHECK_FALSE(streams.next());
}

TEST_CASE("records come in the order of writing after a clock was set back over midnight") {
    Archive archive;
    archive.append(1, kMidnight - seconds(40));
    archive.append(2, kMidnight);
    archive.append(3, kMidnight - seconds(20));  // Set back by 40 s.
    archive.append(4, kMidnight + seconds(20));
    CHECK(sequences_after(archive, std::nullopt) == std::vector{1, 2, 3, 4});
    CHECK(sequences_after(archive, mark(2, kMidnight)) == std::vector{3, 4});
    CHECK(sequences_after(archive, mark(3, kMidnight - seconds(20))) == std::vector{4});
}

TEST_CASE("damage within a day file is skipped and at its end waited for") {
    Archive archive;
    for (int i = 1; i <= 200; ++i) archive.append(i, kNoon + seconds(20 * i));
    const auto spoil = [&](int first, int count) {
        std::fstream file(archive.day_of(kNoon), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp((first - 1) * 512);
        file << std::string(static_cast<std::size_t>(count) * 512, '\xff');
    };
    spoil(10, 1);
    spoil(20, 150);  // More than is read at once.
    auto sequences = sequences_after(archive, std::nullopt);
    CHECK(sequences.size() == 49);
    CHECK(sequences.back() == 200);
    spoil(200, 1);
    sequences = sequences_after(archive, std::nullopt);
    CHECK(sequences.back() == 199);
}

TEST_CASE("a day file that grows too late is reported") {
    Archive archive;
    archive.append(1, kNoon - days(5));
    archive.append(2, kNoon);
    ArchiveStreams streams(archive.root());
    std::chrono::steady_clock::time_point now{};
    const auto look = [&] { streams.look(now += seconds(5)); };
    look();
    streams.place("XX_A351_00_BNZ", std::nullopt, UtcTime::min());
    while (streams.next()) look();
    look();
    CHECK(streams.take_too_old().empty());
    archive.append(3, kNoon - days(4));  // The clock was set back by four days.
    archive.append(4, kNoon - days(1));
    look();
    CHECK(streams.take_too_old() == std::vector{archive.day_of(kNoon - days(4))});
    CHECK(streams.next()->mark.sequence == 4);
    look();
    CHECK(streams.take_too_old().empty());
}

TEST_CASE("copies, impossible days and records of others are not sent") {
    Archive archive;
    for (int i = 1; i <= 3; ++i) archive.append(i, kNoon + seconds(20 * i));
    const auto file = archive.day_of(kNoon);
    std::filesystem::create_directory(archive.root() / "backup");
    std::filesystem::copy(file, archive.root() / "backup" / "XX.OTHER.00.BNZ.D.2026.060");
    std::filesystem::copy(file, file.parent_path() / "XX.A351.00.BNZ.D.2026.999");
    {
        std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekp(512 + 8);
        bytes << "B351";  // Station of the second record.
    }
    ArchiveStreams streams(archive.root());
    streams.look({});
    REQUIRE(streams.unplaced() == std::vector<std::string>{"XX_A351_00_BNZ"});
    streams.place("XX_A351_00_BNZ", std::nullopt, UtcTime::min());
    CHECK(streams.next()->mark.sequence == 1);
    CHECK(streams.next()->mark.sequence == 3);
    const auto damage = streams.take_damage();
    REQUIRE(damage.size() == 1);
    CHECK(damage[0].offset == 512);
    CHECK(damage[0].is_of_another_station);
}

TEST_CASE("a stream that is left out gives nothing") {
    Archive archive;
    archive.append(1, kNoon);
    ArchiveStreams streams(archive.root());
    streams.look({});
    streams.leave_out("XX_A351_00_BNZ");
    streams.look(std::chrono::steady_clock::time_point{} + seconds(5));
    CHECK(streams.unplaced().empty());
    CHECK_FALSE(streams.next());
}

TEST_CASE("headers of answers are read, and all others refused") {
    CHECK(make_packet("READ 7") == std::string("DL\x06READ 7"));
    CHECK(header_length("DL\xff") == 255);
    CHECK_THROWS_AS(header_length("SL\x06"), RingError);
    CHECK(parse_header("OK 4711 0").value() == 4711);
    CHECK(parse_header("ERROR 0 12").data_size == 12);
    CHECK(parse_header("PACKET XX_A351_00_BNZ/MSEED 9 0 0 0 512").data_size == 512);
    CHECK(parse_header("ID DataLink 2026.001 :: DLPROTO:1.0").data_size == 0);
    for (const char* header : {"", " ", "OK", "OK 1 x", "OK 1 -1", "PACKET", "HELLO 3",
                               "INFO STREAMS 99999999999999999999", "OK 1 20000000"})
        CHECK_THROWS_AS(parse_header(header), RingError);
    CHECK_THROWS_AS(parse_header("OK x 0").value(), RingError);
}

TEST_CASE("the list of streams has both forms of names") {
    const auto streams = parse_streams(
        R"(<DataLink><StreamList><Stream Name="FDSN:XX_A351_00_B_N_Z/MSEED" LatestPacketID="12"/>)"
        R"(<Stream Name="XX_A351__LK1/MSEED" LatestPacketID="13"/>)"
        R"(<Stream Name="other/JSON" LatestPacketID="14"/></StreamList></DataLink>)");
    CHECK(streams ==
          std::map<std::string, std::uint64_t>{{"XX_A351_00_BNZ", 12}, {"XX_A351__LK1", 13}});
    CHECK(parse_streams("<DataLink/>").empty());
    CHECK_THROWS_AS(parse_streams("<html/>"), RingError);
    CHECK_THROWS_AS(
        parse_streams(R"(<DataLink><StreamList><Stream Name="x"/></StreamList></DataLink>)"),
        RingError);
}

TEST_CASE("positions are read as they were written, and damaged ones refused") {
    const Positions positions{{"XX_A351_00_BNZ", {4711, mark(999'999, kNoon)}},
                              {"XX_A351__LK1", {1, mark(1, kNoon + Nanoseconds(1))}}};
    CHECK(parse_positions(to_text(positions)) == positions);
    CHECK(parse_positions("")->empty());
    const std::string text = to_text(positions);
    for (std::size_t cut = 1; cut < text.size(); ++cut) {
        if (text[cut - 1] == '\n') continue;
        CHECK_FALSE(parse_positions(text.substr(0, cut)));
    }
}

TEST_CASE("an address has a host and perhaps a port") {
    CHECK(parse_address("ring.example").text() == "ring.example:16000");
    CHECK(parse_address("127.0.0.1:18000").text() == "127.0.0.1:18000");
    CHECK(parse_address("[::1]:1").text() == "[::1]:1");
    for (const char* text :
         {"", ":1", "a:", "a:x", "a:0", "a:65536", "[::1", "[::1]1", "a b", "http://a"})
        CHECK_THROWS_AS(parse_address(text), InputError);
}
