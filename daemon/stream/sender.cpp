#include "daemon/stream/sender.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

#include "protocol/files/file_bytes.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon::stream {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Time between looks for new records: small against their age.
constexpr milliseconds kBetweenLooks{100};
/// Records sent before their acknowledgements are read, so that a slow network carries a day of
/// records in minutes.
constexpr std::size_t kBatch = 64;
/// Longest pause after a failure.
constexpr seconds kLongestPause{30};
constexpr seconds kBetweenSaves{60}, kBetweenComplaints{60};

asio::awaitable<void> wait(milliseconds time) {
    asio::steady_timer timer(co_await asio::this_coro::executor, time);
    error_code error;
    co_await timer.async_wait(into(error));
}

std::string text_of(const Mark& mark) {
    return fmt::format("record {:06} of {}", mark.sequence, to_rfc3339(mark.start, 3));
}

}  // namespace

Sender::Sender(SenderOptions options, std::function<void(const std::string&)> say)
    : options_(std::move(options)), say_(std::move(say)), saved_(Clock::now()) {
    if (options_.state.empty() || !std::filesystem::exists(options_.state)) return;
    const auto bytes = files::read_bytes(options_.state);
    const auto positions =
        parse_positions({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (positions)
        positions_ = *positions;
    else
        say_(options_.state.string() + ": not a file of positions; it is not used");
}

void Sender::save() {
    saved_ = Clock::now();
    if (!is_changed_ || options_.state.empty()) return;
    const std::string text = to_text(positions_);
    files::replace_file(files::posix_files(), options_.state, std::as_bytes(std::span(text)));
    is_changed_ = false;
}

/// Saves while it sends: a full disk must not end a good connection.
void Sender::try_save() {
    try {
        save();
        if (is_save_failing_) say_(options_.state.string() + ": written again");
        is_save_failing_ = false;
    } catch (const std::exception& error) {
        if (!is_save_failing_) say_(std::string(error.what()) + "; tried again once a minute");
        is_save_failing_ = true;
    }
}

asio::awaitable<void> Sender::run() {
    while (true) {
        std::string trouble;
        try {
            co_await session();
            co_return;
        } catch (const RingError& error) {
            trouble = options_.ring.text() + ": " + error.what();
        } catch (const std::exception& error) {
            trouble = error.what();
        }
        note_trouble(trouble);
        co_await wait(pause_);
        pause_ = std::min(2 * pause_, kLongestPause);
    }
}

/// Sends over one connection until it fails, or until all is sent and is_once is set.
asio::awaitable<void> Sender::session() {
    RingConnection ring(co_await asio::this_coro::executor);
    co_await ring.open(options_.ring);
    ArchiveStreams streams(options_.archive);
    Clock::time_point looked;
    while (true) {
        if (const auto now = Clock::now(); now - looked >= kBetweenLooks) {
            streams.look(now);
            looked = now;
        }
        if (!streams.unplaced().empty()) co_await place(ring, streams);
        std::vector<Record> batch;
        while (batch.size() < kBatch) {
            auto record = streams.next();
            if (!record) break;
            batch.push_back(*std::move(record));
        }
        note_damage(streams.take_damage());
        note_too_old(streams.take_too_old());
        if (Clock::now() - saved_ >= kBetweenSaves) try_save();
        const bool is_idle = batch.empty();
        if (!is_idle) co_await send(ring, std::move(batch));
        note_success();
        if (is_idle && options_.is_once) co_return;
        if (is_idle) co_await wait(kBetweenLooks);
    }
}

asio::awaitable<void> Sender::place(RingConnection& ring, ArchiveStreams& streams) {
    const auto names = streams.unplaced();
    const auto latest = co_await ring.latest(names);
    const std::uint64_t earliest = co_await ring.earliest();
    for (const std::string& name : names) {
        if (const auto last = latest.find(name); last != latest.end()) {
            const std::string bytes = co_await ring.read(last->second);
            const auto mark = mark_of(std::as_bytes(std::span(bytes)));
            if (mark) {
                streams.place(name, mark, options_.from);
            } else {
                streams.leave_out(name);
                say_(name +
                     ": the last packet in the ring is not a record of an a351 archive; the "
                     "stream is not sent");
            }
            continue;
        }
        const auto own = positions_.find(name);
        const bool is_new = own == positions_.end() || earliest <= own->second.packet;
        streams.place(name, is_new ? std::nullopt : std::optional(own->second.mark), options_.from);
        say_(fmt::format("{} is not in the ring; it {}", name,
                         is_new ? options_.from == UtcTime::min()
                                      ? "begins with the oldest record"
                                      : "begins at " + to_rfc3339(options_.from)
                                : "continues after " + text_of(own->second.mark)));
    }
}

asio::awaitable<void> Sender::send(RingConnection& ring, std::vector<Record> batch) {
    const auto ids = co_await ring.write(batch);
    for (std::size_t i = 0; i < batch.size(); ++i)
        positions_[batch[i].stream] = {ids[i], batch[i].mark};
    is_changed_ = true;
}

void Sender::note_trouble(const std::string& text) {
    ++attempts_;
    const auto now = Clock::now();
    if (text == trouble_ && now - said_ < kBetweenComplaints) return;
    say_(attempts_ == 1 ? text : fmt::format("{} (attempt {})", text, attempts_));
    trouble_ = text;
    said_ = now;
}

void Sender::note_success() {
    if (attempts_ > 0) say_(options_.ring.text() + ": connected again");
    attempts_ = 0;
    pause_ = kFirstPause;
    trouble_.clear();
}

/// Reports damage; each place once, although every connection finds it again.
void Sender::note_damage(const std::vector<archive::Damage>& damage) {
    for (const archive::Damage& one : damage) {
        std::uint64_t& said = damaged_[one.file];
        if (one.offset + one.byte_count <= said) continue;
        said = one.offset + one.byte_count;
        say_(archive::to_text(one) + "; they are skipped");
    }
}

/// Reports each day file once, although it grows further.
void Sender::note_too_old(const std::vector<std::filesystem::path>& days) {
    for (const auto& file : days)
        if (too_old_.insert(file).second)
            say_(file.filename().string() +
                 ": more than two days older than the last record sent; its new records are not "
                 "sent");
}

}  // namespace a351::daemon::stream
