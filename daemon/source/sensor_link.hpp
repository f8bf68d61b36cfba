#pragma once
/// @file
/// The reader thread.  It finds the port, adopts a known stream that continues there or else starts
/// the sensor's sampling, and reads and time-stamps the bytes.  It starts again when the port
/// disappears, the sensor is silent, its bytes are not frames or its counter shows another rate.
/// After a silence, as of a loose plug at the sensor, the stream may continue at any time: no command
/// is sent while bytes arrive, until it is clear that they are not this stream.
/// While sampling it allocates no memory, logs nothing and does not access the disk.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/port.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/source/sampling_start.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::source {

struct LinkOptions {
    PortAddress address;
    int baud = 460800;
    const wire::DeviceProfile* profile = nullptr;  ///< Not null.
    wire::SensorSettings settings = {};
    std::string expected_serial_number = {};  ///< Empty accepts any.
    /// Header of each session; session, device and clock are filled in later.
    journal::Header header = {};
    /// End of the stream that the journal contains.  The stream is adopted if it continues.
    std::optional<journal::StreamEnd> known = {};
    /// Opens the port; a simulation has ports of its own.
    std::function<std::unique_ptr<Port>(const PortAddress&, int baud)> open = open_port;
};

struct LinkStatus {
    enum class State { searching, handshake, sampling, waiting, stopped };
    State state = State::searching;
    text::Message trouble;  ///< Reason why it is not sampling; empty while sampling.
    std::string port;       ///< Description of the port while open.
    int baud = 0;           ///< Rate in use.
    int configured_baud = 0;
    std::optional<wire::DeviceIdentity> device;  ///< Last one that answered.
    /// Result of the sensor's last start-up test, also if it was in an earlier run.
    wire::StartUpTest start_up_test = wire::StartUpTest::passed;
    bool is_device_assumed = false;  ///< `device` is that of an adopted stream; it was not asked.
    std::uint64_t sessions = 0;      ///< Sessions begun, without adopted ones.
    std::uint64_t adoptions = 0;
    std::uint64_t stalls = 0;
    std::uint64_t ports_lost = 0;
    std::uint64_t handshake_failures = 0;
    std::uint64_t queue_full = 0;    ///< Number of times the reader had to wait for the journal.
    bool waits_for_journal = false;  ///< The reader is waiting for the journal now.
};

[[nodiscard]] const char* to_text(LinkStatus::State state) noexcept;

class SensorLink {
public:
    /// `clock` and `queue` must outlive this.
    SensorLink(LinkOptions options, const HostClock& clock, ReadQueue& queue);
    ~SensorLink() { stop(); }

    /// Tries the port once, then continues in its own thread.
    /// @throws PortError  of kind `locked` only; after other errors the thread tries again.
    void start();

    /// Stops the sensor's sampling if the port is open, and ends the thread.
    void stop();

    [[nodiscard]] LinkStatus status() const;

private:
    enum class End { stopped, stalled, unframed, altered, gone };

    void run() noexcept;
    void open();
    [[nodiscard]] bool find_port();
    [[nodiscard]] bool adopt();
    [[nodiscard]] bool begin_sampling();
    [[nodiscard]] bool is_configurable();
    void handle_failure(const wire::HandshakeFailure& failure, std::size_t bytes_skipped);
    [[nodiscard]] bool try_next_baud();
    [[nodiscard]] End read_stream();
    void note_stall(End end);
    void prepare_session(const journal::SessionId& session, const wire::DeviceIdentity& device,
                         bool is_adopted, std::vector<journal::TxChunk> sent);
    void begin_session();
    void back_off(const text::Message& trouble);
    void wait_for_bytes(Nanoseconds real);
    void expect_stream(std::vector<Read> unread);
    void wait_for_journal();
    /// Calls `push` until it succeeds or the link is stopped; waits for the journal between.
    template <class Push>
    void push_or_wait(Push push) {
        while (!push() && !stop_) wait_for_journal();
        waits_for_journal_ = false;
    }
    void push(ReadQueue::Kind kind, RawTime time, std::span<const std::byte> bytes);
    [[nodiscard]] RawTime push_woken();
    void stop_sensor();
    void lose_port();
    [[nodiscard]] text::Message unplugged() const;
    [[nodiscard]] Nanoseconds real_wait(std::chrono::seconds instrument_span) const;
    void wait(std::chrono::seconds instrument_span);
    void set_state(LinkStatus::State state, text::Message trouble);

    LinkOptions options_;
    const HostClock& clock_;
    ReadQueue& queue_;
    std::unique_ptr<Port> port_;
    bool may_continue_ = false;  ///< The known stream may be on the line; nobody has listened yet.
    bool is_silent_ = false;     ///< No byte came since the stream stopped.
    std::vector<Read> unread_;   ///< Bytes that ended a silence.
    bool was_open_ = false;      ///< The port has been opened at least once.
    std::vector<int> bauds_;     ///< Rates to try; the first is in use.
    std::size_t bauds_tried_ = 0;
    std::size_t failures_in_a_row_ = 0;
    std::size_t strange_bytes_ = 0;  ///< Bytes since the last try that are no answer.
    bool has_frames_ = false;        ///< Frames were received since sampling began.
    Nanoseconds slept_{0};           ///< HostClock::slept() when the last bytes were received.
    /// A session whose sampling was started; it begins with its first byte.
    struct Begun {
        journal::Header header;
        std::vector<journal::TxChunk> sent;
    };
    std::optional<Begun> begun_;
    std::optional<journal::StreamEnd> known_;

    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> queue_full_{0};
    std::atomic<bool> waits_for_journal_{false};
    mutable std::mutex mutex_;  ///< Mutex of status_ and woken_; never locked while bytes flow.
    std::condition_variable woken_;
    LinkStatus status_;
    std::thread thread_;
};

}  // namespace a351::daemon::source
