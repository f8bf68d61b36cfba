#pragma once
/// @file
/// The reader thread: finds the port, adopts the stream that goes on there or brings the sensor
/// into sampling, reads and stamps what comes, and starts again when the port goes, the sensor
/// falls silent, its bytes are no frames or its counter tells of another rate.
/// While sampling it allocates nothing, logs nothing and touches no disk.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/source/adoption.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/source/port.hpp"
#include "daemon/source/read_queue.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/journal/stream_end.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/handshake.hpp"

namespace a351::daemon {

struct LinkOptions {
    PortAddress address;
    int baud = 460800;
    const wire::DeviceProfile* profile = nullptr;  ///< Not null.
    wire::SensorSettings settings = {};
    std::string expected_serial_number = {};  ///< Empty: any.
    /// What each session's header says, save for session, device and clock.
    record::JournalHeader header = {};
    /// Where the stream stood that the journal knows: it is adopted if it goes on.
    std::optional<record::StreamEnd> known = {};
};

struct LinkStatus {
    enum class State { searching, handshake, sampling, waiting, stopped };
    State state = State::searching;
    std::string trouble;  ///< Why it is not sampling; empty when it is.
    std::string port;     ///< Its description while open.
    int baud = 0;         ///< In force.
    int configured_baud = 0;
    std::optional<wire::DeviceIdentity> device;  ///< The last one that answered, or
    bool is_device_assumed = false;              ///< that of the stream that was adopted.
    std::uint64_t sessions = 0;                  ///< Begun; those adopted do not count.
    std::uint64_t adoptions = 0;
    std::uint64_t stalls = 0;
    std::uint64_t ports_lost = 0;
    std::uint64_t handshake_failures = 0;
    std::uint64_t queue_full = 0;  ///< Times the reader had to wait for the journal.
    bool is_held_up = false;       ///< It waits now.
};

[[nodiscard]] const char* to_text(LinkStatus::State state) noexcept;

class SensorLink {
public:
    /// `clock` and `queue` must outlive this.
    SensorLink(LinkOptions options, const HostClock& clock, ReadQueue& queue);
    ~SensorLink();

    /// Tries the port once, then goes on in its own thread.
    /// @throws PortError  of kind `locked` only; other troubles are waited out.
    void start();

    /// Tells the sensor to stop sampling, if it is there, and ends the thread.
    void stop();

    [[nodiscard]] LinkStatus status() const;

private:
    enum class End { stopped, stalled, unframed, altered, gone };

    void run() noexcept;
    void open();
    [[nodiscard]] bool find_port();
    [[nodiscard]] bool adopt();
    void continue_session(const std::vector<Heard>& reads);
    [[nodiscard]] bool begin_sampling();
    [[nodiscard]] bool try_next_baud();
    [[nodiscard]] End read_stream();
    void note_stall(End end);
    void take_up(const wire::DeviceIdentity& device, std::vector<record::TxChunk> sent);
    void begin_session();
    void back_off(const std::string& trouble);
    void hold_up();
    void push(ReadQueue::Kind kind, RawTime time, std::span<const std::byte> bytes);
    [[nodiscard]] RawTime push_woken();
    void stop_sensor();
    void lose_port();
    void wait(std::chrono::seconds instrument_span);
    void set_state(LinkStatus::State state, std::string trouble);

    LinkOptions options_;
    const HostClock& clock_;
    ReadQueue& queue_;
    std::unique_ptr<Port> port_;
    bool is_port_new_ = false;  ///< Opened, and not listened to.
    std::vector<int> bauds_;    ///< To be tried, the first is in force.
    std::size_t bauds_tried_ = 0;
    std::size_t failures_in_a_row_ = 0;
    bool has_frames_ = false;  ///< Since sampling began.
    Nanoseconds slept_{0};     ///< HostClock::slept() when the last bytes came.
    /// A session that was commanded; it begins with its first byte.
    struct Begun {
        record::JournalHeader header;
        std::vector<record::TxChunk> sent;
    };
    std::optional<Begun> begun_;
    std::optional<record::StreamEnd> known_;

    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> queue_full_{0};
    std::atomic<bool> is_held_up_{false};
    mutable std::mutex mutex_;  ///< Of status_ and for woken_; never held while bytes flow.
    std::condition_variable woken_;
    LinkStatus status_;
    std::thread thread_;
};

}  // namespace a351::daemon
