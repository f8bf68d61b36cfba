#pragma once
/// @file
/// An oven's thread: polls its temperature controller at regular intervals, passes each poll to a
/// hook, and opens the port again after a poll that fails.  It only reads, and shares nothing with
/// the sensor's reader.

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/modbus_line.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/oven/controller_values.hpp"
#include "protocol/oven/registers.hpp"

namespace a351::daemon::source {

struct OvenLinkOptions {
    journal::OvenPlace place = journal::OvenPlace::inner;
    ModbusLine::Settings line = {};
    /// Instrument time from poll to poll; at least 100 ms of real time.
    Nanoseconds poll_interval = std::chrono::seconds(1);
    int decimals = 1;  ///< Used if the controller does not report them, 0 ... 3.
};

/// Returns the archive's interval: the poll interval, instrument time, rounded up to whole seconds.
[[nodiscard]] std::chrono::seconds archived_interval(const OvenLinkOptions& options,
                                                     const HostClock& clock);

struct OvenLinkStatus {
    enum class State {
        searching,  ///< The port does not exist or cannot be opened.
        silent,     ///< Nothing is received.
        disturbed,  ///< Something is received, but no valid answer.
        answering   ///< The last answer is not stale.
    };
    State state = State::searching;
    std::string trouble = "not asked yet";         ///< Trouble of the last poll; empty if answered.
    std::string port;                              ///< Description of the port while it is open.
    std::optional<oven::ControllerValues> values;  ///< Values of the last answer.
    int decimals = 1;                              ///< Decimals of process value and set point.
    std::optional<Nanoseconds> age;                ///< Age of the last answer, instrument time.
    bool is_stale = true;                          ///< Last answer older than three polls, or none.
    std::array<std::uint64_t, journal::kOvenOutcomeCount> polls{};  ///< Number of polls by outcome.
};

[[nodiscard]] const char* to_text(OvenLinkStatus::State state) noexcept;
/// Returns the number of polls by the name of their outcome.
[[nodiscard]] std::map<std::string, std::uint64_t> polls_by_outcome(const OvenLinkStatus& status);

class OvenLink {
public:
    using Hook = std::function<void(journal::OvenChunk)>;

    /// `clock` must outlive this.
    /// @param hook  receives each poll, in the oven's thread.
    OvenLink(OvenLinkOptions options, const HostClock& clock, Hook hook);
    ~OvenLink() { stop(); }

    void start() {
        thread_ = std::thread([this] { run(); });
    }

    /// Ends the thread within ModbusLine::kResponseTimeout.
    void stop();

    [[nodiscard]] OvenLinkStatus status() const;

private:
    void run() noexcept;
    [[nodiscard]] bool poll();
    [[nodiscard]] ModbusLine::Answer read_monitors();
    [[nodiscard]] ModbusLine::Answer read_variables(oven::Address first, std::size_t count);
    void ask_decimals();
    void note(const journal::OvenChunk& poll, const std::string& trouble);
    [[nodiscard]] bool is_stale(RawTime now) const;

    OvenLinkOptions options_;
    const HostClock& clock_;
    Hook hook_;
    Nanoseconds real_interval_;
    Nanoseconds stale_after_;  ///< Instrument time.
    std::unique_ptr<ModbusLine> line_;
    bool is_four_byte_ = false;  ///< Mode found in this connection.
    int decimals_;
    int decimal_tries_left_ = 0;  ///< Tries left in this connection; 0 once answered or refused.
    std::size_t failures_in_a_row_ = 0;

    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;  ///< Protects all below; never locked while the port is read.
    std::condition_variable woken_;
    OvenLinkStatus status_;
    std::optional<RawTime> answered_at_;
    std::thread thread_;
};

}  // namespace a351::daemon::source
