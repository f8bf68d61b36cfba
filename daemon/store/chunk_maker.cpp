#include "daemon/store/chunk_maker.hpp"

#include <algorithm>
#include <utility>

#include "protocol/journal/journal_writer.hpp"

namespace a351::daemon::store {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Half of the promised 0.2 s; the disk takes the rest.  Instrument time, and least real time.
constexpr milliseconds kChunkInterval{100}, kShortestChunkInterval{50};
constexpr seconds kClockInterval{1};        // Time between two clock readings: instrument time,
constexpr milliseconds kShortestClockInterval{100};  // and real time.
// Most bytes in a chunk.  With 12 bytes per stamp a chunk stays below the largest size.
constexpr std::size_t kMostBytes = std::size_t{48} << 10;
constexpr std::size_t kMostReads = 1000;

}  // namespace

ChunkMaker::ChunkMaker(const source::HostClock& clock, source::ReadQueue& reads,
                       JournalThread& journal, ChunkQueue& decoded, DiskTime time)
    : clock_(clock), reads_(reads), journal_(journal), decoded_(decoded), time_(std::move(time)) {}

ChunkMaker::~ChunkMaker() {
    if (thread_.joinable()) drain();
}

void ChunkMaker::start() {
    thread_ = std::thread([this] { run(); });
}

void ChunkMaker::run() {
    const auto interval =
        std::max<Nanoseconds>(kShortestChunkInterval, clock_.real_span(kChunkInterval));
    std::unique_lock lock(mutex_);
    while (!woken_.wait_for(lock, interval, [this] { return is_ending_; })) {
        lock.unlock();
        step();
        lock.lock();
    }
}

// A journal that is merely slow makes the reader wait.  One that is stuck does not: it drops its
// oldest chunks.
void ChunkMaker::step() {
    if (journal_.has_room()) {
        make_chunks();
        if (is_clock_due()) pass_clock(clock_.read());
    }
    const std::lock_guard lock(mutex_);
    ++status_.rounds;
}

void ChunkMaker::drain() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
        woken_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
    make_chunks();
    decoded_.close();
}

void ChunkMaker::post(journal::OvenChunk poll) {
    const std::lock_guard lock(mutex_);
    polls_.push_back(std::move(poll));
}

ChunkMaker::Status ChunkMaker::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

void ChunkMaker::make_chunks() {
    auto& rx = std::get<journal::RxChunk>(rx_);
    const auto pass_rx = [&] {
        if (rx.reads.empty()) return;
        pass(rx_);
        rx.bytes.clear();
        rx.reads.clear();
    };
    while (const auto item = reads_.front()) {
        if (item->kind != source::ReadQueue::Kind::rx ||
            rx.bytes.size() + item->bytes.size() > kMostBytes || rx.reads.size() == kMostReads) {
            pass_rx();
        }
        switch (item->kind) {
            case source::ReadQueue::Kind::rx:
                rx.bytes.insert(rx.bytes.end(), item->bytes.begin(), item->bytes.end());
                rx.reads.push_back({static_cast<std::uint32_t>(rx.bytes.size()), item->time});
                reads_.pop();
                break;
            case source::ReadQueue::Kind::tx: {
                const journal::TxChunk tx{item->time, {item->bytes.begin(), item->bytes.end()}};
                reads_.pop();
                pass(tx);
                break;
            }
            case source::ReadQueue::Kind::woken: {
                const timing::ClockReading reading = reads_.woken();
                reads_.pop();
                pass_clock(reading);
                break;
            }
            case source::ReadQueue::Kind::session: {
                const journal::Header header = reads_.take_session();
                reads_.pop();
                pass(header);
                break;
            }
        }
    }
    pass_rx();
    std::unique_lock lock(mutex_);
    polls_to_pass_.swap(polls_);
    lock.unlock();
    for (journal::OvenChunk& poll : polls_to_pass_) pass(std::move(poll));
    polls_to_pass_.clear();
}

bool ChunkMaker::is_clock_due() const {
    return header_ && time_.now() - last_clock_real_ >= kShortestClockInterval &&
           clock_.raw() - last_clock_ >= kClockInterval;
}

void ChunkMaker::pass_clock(const timing::ClockReading& reading) {
    last_clock_ = reading.raw;
    last_clock_real_ = time_.now();
    pass(reading);
}

bool ChunkMaker::is_segment_full(const journal::Chunk& next) const {
    const auto* const reading = std::get_if<timing::ClockReading>(&next);
    const RawTime now = reading != nullptr ? reading->raw : clock_.raw();
    return now - header_->clock.raw >= journal::kLongestSegment ||
           segment_bytes_ >= journal::kLargestSegment;
}

/// Gives a chunk to journal and archive, after the header of a new segment if one is due.  A reader
/// of the journal finds the same chunks in the same order as the archive.
void ChunkMaker::pass(const journal::Chunk& chunk) {
    if (const auto* const header = std::get_if<journal::Header>(&chunk)) {
        header_ = *header;
        segment_bytes_ = 0;
    } else if (!header_) {
        return;
    } else if (is_segment_full(chunk)) {
        // With a clock reading later than the reader's own, the header would include later sleeps.
        const auto* const reading = std::get_if<timing::ClockReading>(&chunk);
        journal::Header next = *header_;
        next.clock = reading != nullptr ? *reading : clock_.read();
        pass(next);
    }
    segment_bytes_ += size_of(chunk);
    journal_.push(++last_number_, chunk);
    if (decoded_.push(last_number_, chunk)) return;
    const std::lock_guard lock(mutex_);
    ++status_.archive_waits;
}

}  // namespace a351::daemon::store
