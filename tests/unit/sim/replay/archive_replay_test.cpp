#include <fstream>
#include <utility>
#include "tests/support/catch.hpp"

#include "protocol/archive/miniseed.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "sim/replay/archive_recording.hpp"
#include "sim/replay/recording.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/sim/replay/replay_host.hpp"

using namespace a351::sim::signal;

namespace a351::sim::replay {
namespace {

using namespace std::chrono_literals;

const UtcTime kStart = *parse_rfc3339("2026-03-01T12:00:00Z");
constexpr Nanoseconds kPeriod = 20ms;

/// Returns the values of sample k: x, y, z, temperature.
std::array<std::int32_t, 4> values_of(int k) { return {k, -7 * k, 16'777'216 + k % 11, -1981 - k}; }

/// A small archive: one file per channel, in records of a few samples.
class Archive {
public:
    /// Appends samples [first, end) of channel `field`, sample k at kStart + k periods + late.
    void add(std::size_t field, int first, int end, Nanoseconds late = 0ns, bool is_run = false) {
        static constexpr std::array<const char*, 4> kChannels{"BN1", "BN2", "BNZ", "BK1"};
        archive::RecordHeader header;
        header.network = "XX";
        header.station = "A351";
        header.location = "00";
        header.channel = kChannels.at(field);
        header.nominal_rate = Hertz(50);
        while (first < end) {
            std::vector<std::int32_t> counts;
            const int most = 30 + static_cast<int>(7 * field);  // Records end at different samples.
            for (int k = first; k < std::min(first + most, end); ++k) {
                counts.push_back(values_of(k).at(field));
            }
            header.start = kStart + first * kPeriod + late;
            header.starts_series = std::exchange(is_run, false);
            const auto packed = archive::pack_record(header, counts);
            std::ofstream(file(field), std::ios::binary | std::ios::app)
                .write(reinterpret_cast<const char*>(packed.bytes.data()), archive::kRecordSize);
            first += static_cast<int>(packed.sample_count);
        }
    }
    void add_all(int first, int end, Nanoseconds late = 0ns) {
        for (std::size_t field = 0; field < 4; ++field) add(field, first, end, late);
    }

    [[nodiscard]] std::filesystem::path file(std::size_t field) const {
        return directory_.path() / ("XX.A351.00.F" + std::to_string(field) + ".D.2026.060");
    }
    [[nodiscard]] std::unique_ptr<Recording> open() const {
        return open_recording({.files = {directory_.path()},
                               .archive_unit = {wire::find_profile("A351"), {}, 460800}});
    }
    [[nodiscard]] ArchiveSource source() const {
        return ArchiveSource({file(0), file(1), file(2), file(3)}, {"1", "2", "Z"});
    }

private:
    test::TemporaryDirectory directory_;
};

std::vector<TimedSample> all_of(ArchiveSource& source) {
    std::vector<TimedSample> samples;
    while (source.next_instant()) samples.push_back(source.next());
    return samples;
}

std::vector<wire::BurstValues> frames_of(const SentPieces& line, wire::BurstLayout layout) {
    wire::BurstDecoder decoder(layout, 80);
    std::vector<wire::BurstValues> values;
    const auto bytes = line.bytes();
    std::span<const std::byte> input(bytes);
    while (const auto event = decoder.next(input)) {
        REQUIRE(std::holds_alternative<wire::BurstFrame>(*event));
        values.push_back(std::get<wire::BurstFrame>(*event).values());
    }
    return values;
}

}  // namespace

TEST_CASE("a gap in an archive is an exact jump of the index, and a drift of record starts is none") {
    Archive archive;
    // 0.2 % over 20 s: 40 ms, two samples.
    for (int k = 0; k < 1000; k += 100) archive.add_all(k, k + 100, k * 40us);
    archive.add_all(1050, 1100, 40ms);
    archive.add_all(6100, 6200, 41ms);
    ArchiveSource source = archive.source();
    CHECK(source.rate_hz() == 50);
    const auto samples = all_of(source);
    REQUIRE(samples.size() == 1150);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto k = static_cast<std::int64_t>(i < 1000 ? i : i < 1050 ? i + 50 : i + 5050);
        REQUIRE(samples[i].index == k);
    }
    CHECK(samples.back().instant == kStart + 6199 * kPeriod + 41ms);
}

TEST_CASE("channels are joined by time, and a sample that one of them lacks is left out") {
    Archive archive;
    for (const std::size_t field : {0U, 1U, 3U}) archive.add(field, 0, 300);
    archive.add(2, 0, 120);
    archive.add(2, 160, 300);
    ArchiveSource source = archive.source();
    const auto samples = all_of(source);
    REQUIRE(samples.size() == 260);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const int k = static_cast<int>(i < 120 ? i : i + 40);
        const auto [x, y, z, temperature] = values_of(k);
        REQUIRE(samples[i].index == k);
        REQUIRE(samples[i].values == SensorSample{{x, y, z}, temperature});
    }
    CHECK(source.incomplete() == 40);
}

TEST_CASE("damage in a day file is skipped and reported") {
    Archive archive;
    archive.add_all(0, 300);
    auto bytes = test::read_bytes(archive.file(1));
    bytes.insert(bytes.begin() + archive::kRecordSize, 100, std::byte{0x55});
    test::write_bytes(archive.file(1), bytes);
    ArchiveSource source = archive.source();
    CHECK(all_of(source).size() == 300);
    REQUIRE(source.damage().size() == 1);
    CHECK(source.damage().front().offset == archive::kRecordSize);
    CHECK(source.damage().front().byte_count == 100);
}

TEST_CASE("an archive without an axis, or with unknown axes, is refused") {
    Archive archive;
    archive.add(3, 0, 10);
    CHECK_THROWS_WITH(archive.open(), ContainsSubstring("no axis among the files"));
    archive.add(0, 0, 10);
    CHECK_NOTHROW(archive.open());
    CHECK_THROWS_WITH(ArchiveSource({archive.file(0)}, {"N", "E", "Z"}),
                      ContainsSubstring("BN1: not of the axes N,E,Z; allowed: --axes"));
}

TEST_CASE("an archive is sent from its first sample in the layout that the host configures") {
    Archive archive;
    archive.add_all(0, 200);
    archive.add_all(1300, 1400);
    const auto burst_ctrl = GENERATE(as<std::uint16_t>{}, 0xC703, 0x4702, 0x0701, 0x0103);
    CAPTURE(burst_ctrl);
    wire::SensorSettings settings;
    settings.layout = *wire::BurstLayout::from_burst_ctrl(burst_ctrl);
    const auto timing = GENERATE(Timing::as_recorded, Timing::as_fast_as_read);
    Device device(archive.open(), timing, Nanoseconds(0));
    ReplayHost host(device, kStart - 10s);
    host.configure(settings);
    host.listen();
    const auto frames = frames_of(host.line, settings.layout);
    REQUIRE(frames.size() == 300);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const int k = static_cast<int>(i < 200 ? i : i + 1100);
        const auto expected = values_of(k);
        REQUIRE(frames[i].axes[2] == expected[2]);
        if (settings.layout.has_axis(wire::Axis::x)) REQUIRE(frames[i].axes[0] == expected[0]);
        if (settings.layout.has_temperature()) REQUIRE(frames[i].temperature == expected[3]);
        if (settings.layout.has_count()) {
            REQUIRE(frames[i].count == static_cast<std::uint16_t>(80 * (k + 1)));
        }
    }
    CHECK_FALSE(device.next_due());
}

TEST_CASE("each run of sampling in an archive waits for the host to start it") {
    Archive archive;
    for (std::size_t field = 0; field < 4; ++field) {
        archive.add(field, 0, 100, 0ns, true);
        archive.add(field, 3000, 3050, 0ns, true);
    }
    Device device(archive.open(), Timing::as_fast_as_read, Nanoseconds(0));
    ReplayHost host(device, kStart);
    const auto layout = wire::SensorSettings{}.layout;
    host.configure();
    host.listen();
    CHECK(frames_of(host.line, layout).size() == 100);
    REQUIRE(device.next_due());
    host.line.pieces.clear();
    host.configure();
    host.listen();
    const auto frames = frames_of(host.line, layout);
    REQUIRE(frames.size() == 50);
    CHECK(frames.front().count == 80);
    CHECK(frames.front().axes[0] == 3000);
    CHECK(device.report().sessions == 2);
    CHECK_FALSE(device.next_due());
}

TEST_CASE("samples of an archive leave the device after its delay") {
    Archive archive;
    archive.add_all(0, 3);
    Device device(archive.open(), Timing::as_recorded, Nanoseconds(0));
    ReplayHost host(device, kStart - 10s);
    host.configure();
    host.listen();
    REQUIRE(host.line.pieces.size() == 3);
    // 511/2 of 1/4000 s, at most 430 us to data ready, 240 bits at 460800 baud.
    const Nanoseconds delay = 63'875us + 430us + 520'833ns;
    for (int k = 0; k < 3; ++k) {
        CHECK(host.line.pieces[static_cast<std::size_t>(k)].leaves == kStart + k * kPeriod + delay);
    }
}

TEST_CASE("fields and rates that an archive lacks are refused in one line") {
    Archive archive;
    for (const std::size_t field : {0U, 1U, 2U}) archive.add(field, 0, 100);
    Device device(archive.open(), Timing::as_recorded, Nanoseconds(0));
    ReplayHost host(device, kStart);
    CHECK_THROWS_WITH(host.configure(), "the host asks for temperature, which the archive lacks");
    wire::SensorSettings settings;
    settings.output_rate_hz = 200;
    settings.filter_code = 0x8;
    CHECK_THROWS_WITH(host.configure(settings), "the host asks for 200 Hz; the archive has 50 Hz");
    settings = {};
    settings.layout = *wire::BurstLayout::from_burst_ctrl(0x0703);
    CHECK_NOTHROW(host.configure(settings));
}

}  // namespace a351::sim::replay
