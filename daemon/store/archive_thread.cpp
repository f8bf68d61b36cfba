#include "daemon/store/archive_thread.hpp"

#include <algorithm>

#include "protocol/record/sds.hpp"

namespace a351::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kSyncInterval{30};
constexpr seconds kModelInterval{10};  // Of instrument time, and
constexpr milliseconds kShortestModelInterval{100};
constexpr seconds kRetryInterval{10};

}  // namespace

ArchiveThread::ArchiveThread(record::FileLayer& files, std::filesystem::path archive,
                             record::StationCodes codes, const HostClock& clock, ChunkQueue& chunks,
                             Progress& progress, Hooks hooks)
    : files_(files),
      archive_(std::move(archive)),
      codes_(std::move(codes)),
      clock_(clock),
      chunks_(chunks),
      progress_(progress),
      hooks_(std::move(hooks)),
      writer_(std::make_unique<record::ArchiveWriter>(files_, archive_, codes_)),
      archiver_(outbox_) {}

ArchiveThread::~ArchiveThread() {
    if (!thread_.joinable()) return;
    chunks_.close();
    hurry();
    join();
}

void ArchiveThread::start() {
    last_sync_ = steady_clock::now();
    thread_ = std::thread([this] { run(); });
}

void ArchiveThread::hurry() {
    const std::lock_guard lock(mutex_);
    is_hurried_ = true;
    hurried_.notify_all();
}

bool ArchiveThread::join() {
    if (thread_.joinable()) thread_.join();
    const std::lock_guard lock(mutex_);
    return !status_.is_faulty;
}

void ArchiveThread::run() noexcept {
    while (const auto numbered = chunks_.pop()) {
        take(*numbered);
        persist([this] { write_outbox(); });
        if (steady_clock::now() - last_sync_ >= kSyncInterval) persist([this] { sync(); });
        post_model();
    }
    {
        const std::lock_guard lock(mutex_);
        archiver_.close_records();
    }
    persist([this] { write_outbox(); });
    persist([this] { sync(); });
}

void ArchiveThread::take(const NumberedChunk& numbered) {
    const auto* const header = std::get_if<record::JournalHeader>(&numbered.chunk);
    {
        const std::lock_guard lock(mutex_);
        if (header != nullptr) {
            session_ = header->session;
            outbox_.last_sample.reset();
        }
        archiver_.take(numbered.chunk);
        status_.counters = archiver_.counters();
        status_.last_sample = outbox_.last_sample;
        if (session_) progress_.parsed(numbered.number, *session_, archiver_.last_index());
    }
    if (header == nullptr) return;
    persist([&] { hooks_.session_began(*header); });
    if (marked_ && marked_ != session_) end_session();
    marked_ = session_;
}

/// The new header has closed the records of the session before; marks never mix sessions.
void ArchiveThread::end_session() {
    persist([this] { write_outbox(); });
    persist([this] { sync(); });
    persist([this] { reopen(); });
}

/// Tries until it works, or once more when in a hurry.
void ArchiveThread::persist(const std::function<void()>& step) {
    while (true) {
        try {
            step();
            const std::lock_guard lock(mutex_);
            status_.is_faulty = false;
            return;
        } catch (const std::exception& error) {
            std::unique_lock lock(mutex_);
            status_.is_faulty = true;
            status_.trouble = error.what();
            ++status_.faults;
            if (is_hurried_) return;
            hurried_.wait_for(lock, kRetryInterval, [this] { return is_hurried_; });
        }
        try {
            reopen();
        } catch (const std::exception&) {
            continue;  // The step fails again and says why.
        }
    }
}

void ArchiveThread::write_outbox() {
    auto& entries = outbox_.entries;  // Only this thread fills it, within take().
    std::size_t written = 0;
    const auto forget_written = [&] {
        entries.erase(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(written));
    };
    try {
        for (const Outbox::Entry& entry : entries) {
            writer_->record(entry.channel, entry.record, entry.last_index);
            ++written;
        }
    } catch (...) {
        forget_written();
        throw;
    }
    forget_written();
    const std::lock_guard lock(mutex_);
    status_.records += written;
}

void ArchiveThread::sync() {
    last_sync_ = steady_clock::now();
    std::vector<record::ChannelMark> marks;
    try {
        marks = writer_->sync();
    } catch (...) {
        are_marks_true_ = false;
        throw;
    }
    if (!marked_ || marks.empty() || !are_marks_true_) return;
    const auto last = std::min_element(
        marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
    progress_.archive_synced(*marked_, last->index);
    hooks_.post(record::MarkChunk{*marked_, std::move(marks)});
}

void ArchiveThread::post_model() {
    const auto now = steady_clock::now();
    if (now - last_model_real_ < kShortestModelInterval) return;
    const RawTime raw = clock_.raw();
    if (raw - last_model_ < kModelInterval) return;
    std::optional<record::ModelChunk> model;
    {
        const std::lock_guard lock(mutex_);
        const auto index = archiver_.last_index();
        const auto* const sample_clock = archiver_.clock();
        if (!index || sample_clock == nullptr) return;
        const auto time = sample_clock->time_of(*index);
        if (time) model = record::ModelChunk{*index, *time};
    }
    if (!model) return;
    last_model_ = raw;
    last_model_real_ = now;
    hooks_.post(*model);
}

/// A fault may have torn the end of a day file: nothing may be appended behind a torn record.
void ArchiveThread::reopen() {
    for (const std::string& channel : record::channels_in(archive_, codes_)) {
        if (const auto file = record::newest_day_file(archive_, codes_, channel)) {
            record::repair_tail(files_, *file);
        }
    }
    writer_ = std::make_unique<record::ArchiveWriter>(files_, archive_, codes_);
}

std::optional<Instant> ArchiveThread::instant_of(std::int64_t index) {
    const timing::SampleClock* const sample_clock = archiver_.clock();
    if (!session_ || sample_clock == nullptr) return std::nullopt;
    const auto time = sample_clock->time_of(index);
    if (!time) return std::nullopt;
    return Instant{*session_, index, time->utc};
}

std::optional<Instant> ArchiveThread::latest() {
    const std::lock_guard lock(mutex_);
    const auto index = archiver_.last_index();
    return index ? instant_of(*index) : std::nullopt;
}

std::optional<Instant> ArchiveThread::at(UtcTime utc) {
    const std::lock_guard lock(mutex_);
    const timing::SampleClock* const sample_clock = archiver_.clock();
    if (sample_clock == nullptr) return std::nullopt;
    const auto index = sample_clock->index_at(utc);
    return index ? instant_of(*index) : std::nullopt;
}

ArchiveStatus ArchiveThread::status() {
    const std::lock_guard lock(mutex_);
    ArchiveStatus status = status_;
    if (const timing::SampleClock* const sample_clock = archiver_.clock()) {
        status.timing_state = sample_clock->state();
        status.timing_uncertainty = sample_clock->uncertainty();
    }
    return status;
}

}  // namespace a351::daemon
