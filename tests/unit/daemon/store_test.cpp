#include "daemon/store/store.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <future>
#include <memory>
#include <system_error>
#include <vector>

#include "protocol/record/archive_reader.hpp"
#include "protocol/record/journal_reader.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"
#include "tests/unit/daemon/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon;

namespace {

constexpr int kFrames = 2000;
constexpr Nanoseconds kPeriod = std::chrono::milliseconds(20);

/// Files whose journal can be made to hang or fail.
class TroubledFiles : public record::FileLayer {
public:
    std::atomic<bool> does_sync_hang{false};
    std::atomic<bool> does_sync_fail{false};
    std::atomic<bool> does_append_fail{false};
    std::atomic<int> hanging{0};

    std::unique_ptr<record::AppendFile> open_append(const std::filesystem::path& file) override {
        if (file.extension() != ".a351j") return files_.open_append(file);
        return std::make_unique<File>(*this, files_.open_append(file));
    }
    void create_directories(const std::filesystem::path& directory) override {
        files_.create_directories(directory);
    }
    void sync_directory(const std::filesystem::path& directory) override {
        files_.sync_directory(directory);
    }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        files_.truncate(file, size);
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        files_.rename(from, to);
    }
    void remove(const std::filesystem::path& file) override { files_.remove(file); }

private:
    class File : public record::AppendFile {
    public:
        File(TroubledFiles& owner, std::unique_ptr<record::AppendFile> file)
            : owner_(owner), file_(std::move(file)) {}
        void append(std::span<const std::byte> bytes) override {
            if (owner_.does_append_fail) throw std::system_error(ENOSPC, std::generic_category());
            file_->append(bytes);
        }
        void sync() override {
            while (owner_.does_sync_hang) {
                owner_.hanging = 1;
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            if (owner_.does_sync_fail) throw std::system_error(EIO, std::generic_category());
            file_->sync();
        }
        [[nodiscard]] std::uint64_t size() const override { return file_->size(); }

    private:
        TroubledFiles& owner_;
        std::unique_ptr<record::AppendFile> file_;
    };

    record::FileLayer& files_ = record::posix_files();
};

struct Rig {
    TemporaryDirectory directory;
    std::filesystem::path root = directory.path() / "data";
    TroubledFiles files;
    HostClock clock;
    ReadQueue reads;
    RawTime first = clock.raw() - kFrames * kPeriod;
    int fed = 0;
    std::vector<std::byte> bytes;

    [[nodiscard]] StoreOptions options() const {
        StoreOptions options;
        options.root = root;
        options.retry_interval = std::chrono::milliseconds(100);
        options.station.profile = "A351";
        options.station.output_rate_hz = 50;
        options.station.filter = "k512_fc9";
        return options;
    }

    void begin_session() {
        record::JournalHeader header;
        header.session.bytes[0] = 42;
        header.boot_id = clock.boot_id();
        header.profile = "A351";
        header.product_id = "A351AU10";
        header.serial_number = "00000042";
        header.output_rate_hz = 50;
        header.filter = "k512_fc9";
        header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
        header.baud = 460800;
        header.clock = clock.read();
        REQUIRE(reads.push_session(header, header.clock.raw));
    }

    void feed(int count) {
        std::vector<std::byte> frame;
        for (int i = 0; i < count; ++i, ++fed) {
            frame.clear();
            wire::append_frame(wire::BurstLayout::recommended(), FakeSensor::values(fed), frame);
            REQUIRE(reads.push(ReadQueue::Kind::rx, first + fed * kPeriod, frame));
            bytes.insert(bytes.end(), frame.begin(), frame.end());
        }
    }
};

Status status_of(Store& store) {
    Status status;
    store.fill(status);
    return status;
}

struct JournalContent {
    std::vector<std::byte> bytes;
    std::vector<std::string> events;
    std::vector<record::MarkChunk> marks;
};

JournalContent read_journal(const std::filesystem::path& root) {
    JournalContent content;
    for (const auto& segment : record::journal_segments(root / "journal")) {
        record::JournalReader reader(segment);
        while (const auto chunk = reader.next()) {
            if (const auto* rx = std::get_if<record::RxChunk>(&*chunk)) {
                content.bytes.insert(content.bytes.end(), rx->bytes.begin(), rx->bytes.end());
            } else if (const auto* event = std::get_if<record::EventChunk>(&*chunk)) {
                content.events.push_back(event->json);
            } else if (const auto* mark = std::get_if<record::MarkChunk>(&*chunk)) {
                content.marks.push_back(*mark);
            }
        }
    }
    return content;
}

std::vector<std::int32_t> archived_counts(const std::filesystem::path& root, const char* channel) {
    const auto data =
        record::read_channel(root / "archive", {}, channel, UtcTime(std::chrono::hours(0)),
                             UtcTime(std::chrono::hours(24 * 365 * 200)));
    std::vector<std::int32_t> counts;
    for (const record::Segment& segment : data.segments) {
        counts.insert(counts.end(), segment.counts.begin(), segment.counts.end());
    }
    return counts;
}

std::vector<std::int32_t> expected_counts(int frames) {
    std::vector<std::int32_t> counts;
    for (int i = 0; i < frames; ++i) counts.push_back(FakeSensor::values(i).axes[2]);
    return counts;
}

}  // namespace

TEST_CASE_METHOD(Rig, "what was read is in the journal byte by byte and in the archive once",
                 "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(kFrames);
    CHECK(store.stop());

    const JournalContent journal = read_journal(root);
    CHECK(journal.bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(kFrames));
    const Status status = status_of(store);
    CHECK(status.received == kFrames - 1);
    CHECK(status.journaled == kFrames - 1);
    CHECK(status.archived == kFrames - 1);
    REQUIRE(journal.marks.size() == 1);
    CHECK(journal.marks[0].session.bytes[0] == 42);
    CHECK(std::filesystem::exists(root / "metadata" / "station.xml"));
}

TEST_CASE_METHOD(Rig, "no sample is called journaled before its bytes are synced",
                 "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).journaled == 99; }));

    files.does_sync_hang = true;
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).received == 199 && files.hanging == 1; }));
    CHECK(status_of(store).journaled == 99);
    files.does_sync_hang = false;
    CHECK(eventually([&] { return status_of(store).journaled == 199; }));
    CHECK(store.stop());
}

TEST_CASE_METHOD(Rig, "after a failed sync its samples are called journaled only when archived",
                 "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).journaled == 99; }));

    files.does_sync_fail = true;
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).more_counters["journal_faults"] > 0; }));
    files.does_sync_fail = false;
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).received == 299; }));
    CHECK(status_of(store).journaled == 99);
    CHECK(store.stop());
    CHECK(status_of(store).journaled == 299);
    CHECK(archived_counts(root, "BNZ") == expected_counts(300));
}

TEST_CASE_METHOD(Rig, "what a full disk refused is kept and written when there is space",
                 "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).journaled == 99; }));

    files.does_append_fail = true;
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).more_counters["journal_faults"] > 0; }));
    feed(100);
    CHECK(status_of(store).level == Status::Level::fault);
    files.does_append_fail = false;
    CHECK(store.stop());
    CHECK(read_journal(root).bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(300));
}

TEST_CASE_METHOD(Rig, "an event is in journal and event log once commit returns",
                 "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    record::Event event;
    event.type = "note";
    event.utc = clock.now();
    event.details["note"] = "before the first session";
    store.commit(event);
    CHECK(record::read_events(root / "events").events.size() == 1);

    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return store.latest().has_value(); }));
    event.details["note"] = "wind";
    store.commit(event);
    const JournalContent journal = read_journal(root);
    REQUIRE(journal.events.size() == 1);
    CHECK(journal.events[0] == record::to_json(event));
    CHECK(record::read_events(root / "events").events.size() == 2);

    files.does_append_fail = true;
    CHECK_THROWS_AS(store.commit(event), std::system_error);
    CHECK(record::read_events(root / "events").events.size() == 2);
    files.does_append_fail = false;
}

TEST_CASE_METHOD(Rig, "the store says which sample belongs to an instant", "[daemon][store]") {
    Store store(files, options(), clock, reads);
    store.start();
    CHECK_FALSE(store.latest());
    begin_session();
    feed(kFrames);
    REQUIRE(eventually([&] { return status_of(store).received == kFrames - 1; }));
    const auto latest = store.latest();
    REQUIRE(latest);
    CHECK(latest->index == kFrames - 1);
    CHECK(latest->session.bytes[0] == 42);
    const auto earlier = store.at(latest->utc - 500 * kPeriod);
    REQUIRE(earlier);
    // Times are fixed in steps of a second that may differ by 0.2 ms, a hundredth of a sample.
    CHECK(std::abs(earlier->index - (kFrames - 1 - 500)) <= 1);
    CHECK_FALSE(store.at(latest->utc + kPeriod));
    CHECK_FALSE(store.at(latest->utc - (kFrames + 10) * kPeriod));
}

TEST_CASE_METHOD(Rig, "after a crash the next start completes the archive", "[daemon][store]") {
    const auto crashed = directory.path() / "crashed";
    {
        Store store(files, options(), clock, reads);
        store.start();
        begin_session();
        feed(kFrames);
        REQUIRE(eventually([&] { return status_of(store).journaled == kFrames - 1; }));
        std::filesystem::copy(root, crashed, std::filesystem::copy_options::recursive);
    }
    const auto segments = record::journal_segments(crashed / "journal");
    REQUIRE(segments.size() == 1);
    std::ofstream(segments[0], std::ios::app) << "torn";

    StoreOptions again = options();
    again.root = crashed;
    Store store(files, again, clock, reads);
    CHECK(store.recovery().journal.has_value());
    CHECK(store.recovery().records_added > 0);
    CHECK(archived_counts(crashed, "BNZ") == expected_counts(kFrames));
}

TEST_CASE_METHOD(Rig, "a data root takes one daemon at a time", "[daemon][store]") {
    {
        const Store store(files, options(), clock, reads);
        CHECK_THROWS_AS(Store(files, options(), clock, reads), DataRootLocked);
    }
    CHECK_NOTHROW(Store(files, options(), clock, reads));
}

TEST_CASE_METHOD(Rig, "station metadata are replaced only when they say something else",
                 "[daemon][data_root]") {
    record::StationDescription station = options().station;
    station.start = clock.now();
    station.serial_number = "00000042";
    files.create_directories(root / "metadata");
    const auto file = root / "metadata" / "station.xml";
    describe_station(files, root, station);
    const auto first_written = text::read_text_file(file);
    station.start += std::chrono::hours(1);
    describe_station(files, root, station);
    CHECK(text::read_text_file(file) == first_written);
    station.serial_number = "00000043";
    describe_station(files, root, station);
    CHECK(text::read_text_file(file) != first_written);
}
