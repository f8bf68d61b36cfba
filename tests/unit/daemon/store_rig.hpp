#pragma once
/// @file
/// A store over files that can be made to hang or fail, fed with frames of known values.

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <system_error>
#include <vector>
#include "tests/support/catch.hpp"

#include "daemon/store/store.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/files/file_bytes.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"
#include "tests/unit/files/forwarding_files.hpp"

namespace a351::daemon {

inline constexpr int kFrames = 2000;
inline constexpr Nanoseconds kPeriod = std::chrono::milliseconds(20);

/// Files whose journal can be made to hang or fail, and whose archive can be made to fail.
class TroubledFiles : public test::ForwardingFiles {
public:
    std::atomic<bool> does_sync_hang{false};
    std::atomic<bool> does_append_fail{false};
    std::atomic<bool> does_archive_fail{false};
    std::atomic<bool> does_archive_sync_fail{false};
    std::atomic<int> error_of_archive_sync{EIO};
    std::atomic<bool> does_archive_hang{false};
    std::atomic<int> hanging{0}, archive_hanging{0};
    std::atomic<std::uint64_t> free{std::uint64_t{100} << 30};
    mutable std::atomic<int> looks{0};  ///< Number of questions for the free space.

    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path&) const override {
        ++looks;
        return free;
    }
    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        if (file.extension() == ".a351j")
            return std::make_unique<JournalFile>(*this, files_.open_append(file));
        const bool is_day_file = file.filename().string().find(".D.") != std::string::npos;
        if (!is_day_file) return files_.open_append(file);
        if (does_archive_fail) throw std::system_error(ENOSPC, std::generic_category());
        return std::make_unique<ArchiveFile>(*this, files_.open_append(file));
    }

private:
    class JournalFile : public test::ForwardingFile {
    public:
        JournalFile(TroubledFiles& owner, std::unique_ptr<files::AppendFile> file)
            : test::ForwardingFile(std::move(file)), owner_(owner) {}
        void append(std::span<const std::byte> bytes) override {
            if (owner_.does_append_fail) throw std::system_error(ENOSPC, std::generic_category());
            file_->append(bytes);
        }
        void sync() override {
            while (owner_.does_sync_hang) {
                owner_.hanging = 1;
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            file_->sync();
        }

    private:
        TroubledFiles& owner_;
    };

    class ArchiveFile : public test::ForwardingFile {
    public:
        ArchiveFile(TroubledFiles& owner, std::unique_ptr<files::AppendFile> file)
            : test::ForwardingFile(std::move(file)), owner_(owner) {}
        void append(std::span<const std::byte> bytes) override {
            while (owner_.does_archive_hang) {
                owner_.archive_hanging = 1;
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            file_->append(bytes);
        }
        void sync() override {
            if (owner_.does_archive_sync_fail)
                throw std::system_error(owner_.error_of_archive_sync, std::generic_category(),
                                        "sync of the archive");
            file_->sync();
        }

    private:
        TroubledFiles& owner_;
    };
};

inline status::Status status_of(store::Store& store) {
    status::Status status;
    store.fill(status);
    return status;
}

inline bool has_reason(const status::Status& status, const std::string& part) {
    return std::ranges::any_of(status.reasons, [&](const text::Message& reason) {
        return reason.english().find(part) != std::string::npos;
    });
}

inline events::Event note_at(UtcTime utc, const std::string& text = "") {
    events::Event event{"note", utc, {}, {}, {}};
    event.details["note"] = text;
    return event;
}

struct Rig {
    test::TemporaryDirectory directory;
    std::filesystem::path root = directory.path() / "data";
    TroubledFiles files;
    source::HostClock clock;
    source::ReadQueue reads;
    RawTime first = clock.raw() - kFrames * kPeriod;
    int fed = 0;
    std::vector<std::byte> bytes;

    explicit Rig(std::size_t queue_bytes = source::ReadQueue::kCapacity) : reads(queue_bytes) {}

    [[nodiscard]] store::Options options() const {
        store::Options options;
        options.root = root;
        options.time.retry_interval = std::chrono::milliseconds(100);
        options.reserve_bytes = std::uint64_t{1} << 20;
        options.commit_patience = std::chrono::milliseconds(500);
        options.station.profile = "A351";
        options.station.output_rate_hz = 50;
        options.station.filter = "k512_fc9";
        return options;
    }

    std::string serial_number = "00000042";                       ///< Of the next sessions.
    wire::StartUpTest start_up_test = wire::StartUpTest::passed;  ///< Of the next sessions.

    void begin_session(std::uint8_t id = 42, const char* profile = "A351",
                       Nanoseconds ago = Nanoseconds(0)) {
        journal::Header header;
        header.session.bytes[0] = id;
        header.boot_id = clock.boot_id();
        header.profile = profile;
        header.product_id = "A351AU10";
        header.serial_number = serial_number;
        header.start_up_test = start_up_test;
        header.output_rate_hz = 50;
        header.filter = "k512_fc9";
        header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
        header.baud = 460800;
        header.clock = clock.read();
        header.clock.realtime -= ago;
        header.clock.is_synchronised = true;
        REQUIRE(reads.push_session(header, header.clock.raw));
    }

    /// Starts the store and records samples 0 ... 99.
    void record_first(store::Store& store) {
        store.start();
        begin_session();
        feed(100);
        REQUIRE(eventually([&] { return status_of(store).journaled == 99; }));
    }

    void feed(int count) {
        std::vector<std::byte> frame;
        for (int i = 0; i < count; ++i, ++fed) {
            frame.clear();
            wire::append_frame(wire::BurstLayout::recommended(), FakeSensor::values(fed), frame);
            REQUIRE(reads.push(source::ReadQueue::Kind::rx, first + fed * kPeriod, frame));
            bytes.insert(bytes.end(), frame.begin(), frame.end());
        }
    }
};

/// A store that has recorded samples 0 ... 99.
struct RecordingRig : Rig {
    store::Store store{files, options(), clock, reads};

    explicit RecordingRig(std::size_t queue_bytes = source::ReadQueue::kCapacity)
        : Rig(queue_bytes) {
        record_first(store);
    }
};

/// Starts and stops a store, like a daemon without a sensor.  @return the report of its recovery
inline archive::RecoveryReport recover(files::FileLayer& files, store::Options options,
                                       const source::HostClock& clock) {
    source::ReadQueue nothing;
    std::promise<archive::RecoveryReport> recovered;
    options.recovered = [&](const auto& report) { recovered.set_value(report); };
    store::Store store(files, std::move(options), clock, nothing);
    store.start();
    auto report = recovered.get_future().get();
    REQUIRE(store.stop());
    return report;
}

struct JournalContent {
    std::vector<std::byte> bytes;
    std::vector<std::string> events;
    std::vector<journal::MarkChunk> marks;
};

inline JournalContent read_journal(const std::filesystem::path& root) {
    JournalContent content;
    journal::Sequence chunks(journal::segment_files(root / "journal"));
    while (const auto chunk = chunks.next()) {
        if (const auto* rx = std::get_if<journal::RxChunk>(&*chunk)) {
            content.bytes.insert(content.bytes.end(), rx->bytes.begin(), rx->bytes.end());
        } else if (const auto* event = std::get_if<journal::EventChunk>(&*chunk)) {
            content.events.push_back(event->json);
        } else if (const auto* mark = std::get_if<journal::MarkChunk>(&*chunk)) {
            content.marks.push_back(*mark);
        }
    }
    return content;
}

inline std::vector<std::int32_t> archived_counts(const std::filesystem::path& root,
                                                 const char* channel) {
    const auto data =
        archive::read_channel(root / "archive", {}, channel, UtcTime(std::chrono::hours(0)),
                              UtcTime(std::chrono::hours(24 * 365 * 200)));
    std::vector<std::int32_t> counts;
    for (const archive::Segment& segment : data.segments)
        counts.insert(counts.end(), segment.counts.begin(), segment.counts.end());
    return counts;
}

/// Returns the samples of all records in the order of the files, including overlaps.
inline std::vector<std::int32_t> recorded_counts(const std::filesystem::path& root,
                                                 const char* channel) {
    std::vector<std::int32_t> counts;
    for (const auto& file : archive::day_files(root / "archive", {}, channel)) {
        const auto bytes = files::read_bytes(file);
        for (std::size_t at = 0; at < bytes.size(); at += archive::kRecordSize) {
            const auto decoded =
                archive::decode_record(std::span(bytes).subspan(at, archive::kRecordSize));
            REQUIRE(decoded);
            counts.insert(counts.end(), decoded->samples.begin(), decoded->samples.end());
        }
    }
    return counts;
}

inline std::size_t samples_in_records(const std::filesystem::path& root, const char* channel) {
    return recorded_counts(root, channel).size();
}

inline std::vector<std::int32_t> expected_counts(int frames) {
    std::vector<std::int32_t> counts;
    for (int i = 0; i < frames; ++i) counts.push_back(FakeSensor::values(i).axes[2]);
    return counts;
}

}  // namespace a351::daemon
