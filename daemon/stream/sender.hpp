#pragma once
/// @file
/// Sends the records of an archive to a ring, and continues after any outage of either side.
///
/// The ring itself knows what it has: after each connection its last packet of every stream is read
/// and looked up in the archive.  So a record whose acknowledgement was lost is not sent again.  It
/// comes twice only if the server works through an old connection after it answered the new one.
///
/// If the ring has no packet of a stream, either the packets of others have replaced it, or the
/// ring is new.  It is new if it is empty, or if it should still have the packet acknowledged last:
/// its oldest packet has a smaller ID.  The stream of a new ring begins at SenderOptions::from; else
/// it continues after the record acknowledged last, as the file of positions has it: up to a minute
/// old after a kill.

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/stream/own_positions.hpp"
#include "daemon/stream/ring_connection.hpp"

namespace a351::daemon::stream {

struct SenderOptions {
    std::filesystem::path archive;  ///< Root of the archive; it may be missing.
    Address ring;
    UtcTime from = UtcTime::min();  ///< Records that end before are not sent to a new ring.
    std::filesystem::path state;    ///< File of positions; empty: none.
    bool is_once = false;           ///< End when all records are sent; else wait for more.
};

/// Sends records.  Outages are reported and waited for; they never end it.
class Sender {
public:
    /// @param say  receives a line at each change; a lasting trouble once a minute, with its count.
    /// @throws std::system_error  the file of positions cannot be read.
    Sender(SenderOptions options, std::function<void(const std::string&)> say);

    /// Runs until is_once is fulfilled, or for ever.  It may be destroyed at any time.
    asio::awaitable<void> run();

    /// Writes the file of positions, if it has changed.
    /// @throws std::system_error  it cannot be written.
    void save();

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kFirstPause{1};

    asio::awaitable<void> session();
    asio::awaitable<void> place(RingConnection& ring, ArchiveStreams& streams);
    asio::awaitable<void> send(RingConnection& ring, std::vector<Record> batch);
    void note_trouble(const std::string& text);
    void note_success();
    void note_damage(const std::vector<archive::Damage>& damage);
    void note_too_old(const std::vector<std::filesystem::path>& days);
    void try_save();

    SenderOptions options_;
    std::function<void(const std::string&)> say_;
    Positions positions_;
    bool is_changed_ = false;
    bool is_save_failing_ = false;
    Clock::time_point saved_;
    std::string trouble_;  ///< Trouble said last; empty while all is well.
    int attempts_ = 0;     ///< Attempts that failed since the last success.
    Clock::time_point said_;
    std::chrono::seconds pause_ = kFirstPause;  ///< Until the next attempt; it doubles.
    std::map<std::filesystem::path, std::uint64_t> damaged_;  ///< End of damage said, by file.
    std::set<std::filesystem::path> too_old_;                 ///< Day files said.
};

}  // namespace a351::daemon::stream
