#include "daemon/store/journal_keeper.hpp"

#include <pthread.h>
#include <sched.h>

#include <optional>
#include <utility>

#include "protocol/record/journal_compression.hpp"
#include "protocol/record/journal_reader.hpp"

namespace a351::daemon {
namespace {

namespace fs = std::filesystem;

/// By a clock that was synchronised.
std::optional<UtcTime> beginning_of(const fs::path& segment) {
    record::JournalReader reader(segment);
    const auto chunk = reader.next();
    const auto* header = chunk ? std::get_if<record::JournalHeader>(&*chunk) : nullptr;
    if (header == nullptr || !header->clock.is_synchronised) return std::nullopt;
    return header->clock.realtime;
}

}  // namespace

JournalKeeper::JournalKeeper(record::FileLayer& files, fs::path journal, Options options,
                             std::function<std::uint64_t()> covered_below)
    : files_(files),
      journal_(std::move(journal)),
      options_(options),
      covered_below_(std::move(covered_below)) {}

JournalKeeper::~JournalKeeper() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
        stopped_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void JournalKeeper::start() {
    thread_ = std::thread([this] { run(); });
}

JournalKeeper::Status JournalKeeper::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

bool JournalKeeper::is_stopping() const {
    const std::lock_guard lock(mutex_);
    return is_stopping_;
}

void JournalKeeper::run() noexcept {
    const sched_param none{};
    pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, options_.interval, [this] { return is_stopping_; })) {
        lock.unlock();
        std::string trouble;
        try {
            tidy();
        } catch (const std::exception& error) {
            trouble = error.what();
        }
        lock.lock();
        if (trouble.empty()) continue;
        ++status_.faults;
        status_.trouble = std::move(trouble);
    }
}

void JournalKeeper::tidy() {
    remove_old();
    compress_closed();
}

void JournalKeeper::remove_old() {
    if (options_.keep_days == 0) return;
    const auto segments = record::journal_segments(journal_);
    if (segments.size() < 2) return;
    const auto newest = beginning_of(segments.back());
    const std::uint64_t covered_below = covered_below_();
    for (std::size_t i = 0; newest && i + 1 < segments.size(); ++i) {
        if (record::segment_number(segments[i]).value_or(covered_below) >= covered_below) return;
        // All of it is older than the beginning of the next one.
        const auto end = beginning_of(segments[i + 1]);
        if (!end || *newest - *end < std::chrono::days(options_.keep_days)) return;
        files_.remove(segments[i]);
        files_.sync_directory(journal_);
        const std::lock_guard lock(mutex_);
        ++status_.removed;
    }
}

void JournalKeeper::compress_closed() {
    const auto segments = record::journal_segments(journal_);
    for (std::size_t i = 0; i + 1 < segments.size() && !is_stopping(); ++i) {
        if (segments[i].extension() != ".a351j") continue;
        const auto age = fs::file_time_type::clock::now() - fs::last_write_time(segments[i]);
        if (age < options_.compress_after) continue;
        record::compress_segment(files_, segments[i]);
        const std::lock_guard lock(mutex_);
        ++status_.compressed;
    }
}

}  // namespace a351::daemon
