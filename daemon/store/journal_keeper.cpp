#include "daemon/store/journal_keeper.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/journal/journal_compression.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::daemon::store {
namespace {

namespace fs = std::filesystem;

struct Segment {
    fs::path path;
    journal::Header header;
};

/// Returns the segments whose header can be read.
std::vector<Segment> readable_segments(const fs::path& journal) {
    std::vector<Segment> segments;
    for (const fs::path& path : journal::segment_files(journal))
        if (const auto header = journal::segment_header(path)) segments.push_back({path, *header});
    return segments;
}

/// Returns the session of the newest MARK.  Earlier sessions are complete in the archive.
std::optional<journal::SessionId> marked_session(const std::vector<Segment>& segments) {
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment)
        if (const auto mark = journal::newest_mark(segment->path)) return mark->session;
    return std::nullopt;
}

}  // namespace

JournalKeeper::JournalKeeper(files::FileLayer& files, fs::path journal, Options options)
    : files_(files), journal_(std::move(journal)), options_(options) {}

JournalKeeper::~JournalKeeper() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
        stopped_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

JournalKeeper::Status JournalKeeper::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

void JournalKeeper::run() noexcept {
    const sched_param none{};
    pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, options_.interval, [this] { return is_stopping_.load(); })) {
        lock.unlock();
        tidy();
        lock.lock();
    }
}

void JournalKeeper::note_fault(const std::string& trouble) {
    trouble_ = trouble;
    const std::lock_guard lock(mutex_);
    ++status_.faults;
}

void JournalKeeper::tidy() noexcept {
    try {
        if (options_.keep_days > 0) remove_old();
        if (!are_names_read_) compress_closed();
    } catch (const std::exception& error) {
        note_fault(error.what());
    }
    const std::lock_guard lock(mutex_);
    status_.trouble = std::exchange(trouble_, {});
}

void JournalKeeper::remove_old() {
    const auto names = journal::segment_files(journal_);
    if (names.empty()) return;
    const auto first = journal::segment_time(names.front()),
               last = journal::segment_time(names.back());
    const auto kept = std::chrono::days(options_.keep_days);
    if (first && last && *last - *first < kept) return;

    const auto segments = readable_segments(journal_);
    // The loop goes from newest to oldest.  A segment that begins by a synchronised clock begins
    // after the end of all earlier ones.
    std::optional<UtcTime> newest, followed_at;
    std::size_t old = segments.size();  // Segments before this one are old enough.
    for (; old > 0; --old) {
        if (newest && *newest - *followed_at >= kept) break;
        const timing::ClockReading& clock = segments[old - 1].header.clock;
        if (!clock.is_synchronised) continue;
        followed_at = clock.realtime;
        if (!newest) newest = clock.realtime;
    }
    // A session that continues into a newer segment is kept as a whole.
    while (old > 0 && old < segments.size() &&
           segments[old - 1].header.session == segments[old].header.session)
        --old;
    if (old == 0) return;
    const auto marked = marked_session(segments);
    const auto first_marked = std::find_if(segments.begin(), segments.end(), [&](const Segment& s) {
        return s.header.session == marked;
    });
    old = std::min(old, static_cast<std::size_t>(first_marked - segments.begin()));
    if (first_marked == segments.end()) return;
    for (; old > 0 && !is_stopping_; --old) {
        files_.remove(segments[old - 1].path);
        files_.sync_directory(journal_);
        const std::lock_guard lock(mutex_);
        ++status_.removed;
    }
}

void JournalKeeper::compress_closed() {
    const auto segments = journal::segment_files(journal_);
    for (std::size_t i = 0; i + 1 < segments.size() && !is_stopping_; ++i) {
        if (segments[i].extension() != ".a351j") continue;
        const auto age = fs::file_time_type::clock::now() - fs::last_write_time(segments[i]);
        if (age < options_.compress_after) continue;
        try {
            journal::compress_segment(files_, segments[i]);
        } catch (const std::exception& error) {
            note_fault(error.what());
            continue;
        }
        const std::lock_guard lock(mutex_);
        ++status_.compressed;
    }
}

}  // namespace a351::daemon::store
