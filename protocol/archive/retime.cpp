#include "protocol/archive/retime.hpp"

#include <memory>
#include <optional>
#include <system_error>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/retiming.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/events/event_log.hpp"

namespace a351::record {
namespace {

namespace fs = std::filesystem;

using Segments = std::vector<fs::path>;

struct Discard final : ArchiveSink {
    void record(const std::string&, const PackedRecord&, std::int64_t) override {}
};

/// Writes the archives of one data root; the codes of a station may change between sessions.
class Archives final : public ArchiveSink {
public:
    Archives(FileLayer& files, fs::path archive) : files_(files), archive_(std::move(archive)) {}

    void begin(const StationCodes& codes) {
        if (writer_ && codes == codes_) return;
        finish();
        codes_ = codes;
        writer_ = std::make_unique<ArchiveWriter>(files_, archive_, codes);
    }
    void record(const std::string& channel, const PackedRecord& packed,
                std::int64_t last_index) override {
        writer_->record(channel, packed, last_index);
    }
    void finish() {
        if (!writer_) return;
        static_cast<void>(writer_->sync());
        records_ += writer_->records_written();
        writer_.reset();
    }
    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }

private:
    FileLayer& files_;
    fs::path archive_;
    StationCodes codes_;
    std::unique_ptr<ArchiveWriter> writer_;
    std::uint64_t records_ = 0;
};

void gather(const Segments& segments, Retiming& retiming) {
    Discard nothing;
    Archiver archiver(nothing, &retiming);
    JournalSequence chunks(segments);
    while (const auto chunk = chunks.next()) archiver.take(*chunk);
}

void write(const Segments& segments, Retiming& retiming, Archives& archives, RetimeReport& report) {
    retiming.begin_second_pass();
    Archiver archiver(archives, &retiming);
    std::optional<StationCodes> codes;
    JournalSequence chunks(segments);
    while (const auto chunk = chunks.next()) {
        if (const auto* header = std::get_if<JournalHeader>(&*chunk);
            header && header->codes != codes) {
            archiver.close_records();  // under their own codes
            archives.begin(header->codes);
            codes = header->codes;
        }
        archiver.take(*chunk);
    }
    report.damage = chunks.damage();
    archiver.close_records();
    archives.finish();
    report.records = archives.records();
    report.counters = archiver.counters();
}

void write_events(FileLayer& files, const fs::path& root, const fs::path& out,
                  const Retiming& retiming) {
    for (Event event : read_events(root / "events").events) {
        if (event.session && event.index) {
            if (const auto utc = retiming.time_of(*event.session, *event.index, event.utc))
                event.utc = *utc;
        }
        append_event(files, out / "events", event);
    }
}

}  // namespace

RetimeReport retime(FileLayer& files, const fs::path& root, const fs::path& out_as_given) {
    const fs::path out = out_as_given.has_filename() ? out_as_given : out_as_given.parent_path();
    const Segments segments = journal_segments(root / "journal");
    if (segments.empty())
        throw InputError(root.string() + ": no journal; allowed: the data root of a daemon");
    if (fs::exists(out))
        throw InputError("--out " + out.string() + ": already exists; allowed: a new directory");
    fs::path partial = out;
    partial += ".partial";
    if (fs::exists(partial)) {
        throw InputError("--out " + out.string() + ": " + partial.string() +
                         " was left by an interrupted run; remove it first");
    }
    RetimeReport report;
    report.segments = segments.size();
    try {
        files.create_directories(partial);
        Retiming retiming;
        gather(segments, retiming);
        Archives archives(files, partial / "archive");
        write(segments, retiming, archives, report);
        write_events(files, root, partial, retiming);
        if (fs::exists(root / "metadata")) {
            fs::copy(root / "metadata", partial / "metadata", fs::copy_options::recursive);
        }
        files.rename(partial, out);
        files.sync_directory(fs::absolute(out).parent_path());
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(partial, ignored);
        throw;
    }
    return report;
}

}  // namespace a351::record
