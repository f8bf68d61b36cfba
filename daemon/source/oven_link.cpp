#include "daemon/source/oven_link.hpp"

#include <algorithm>
#include <utility>

#include "daemon/source/back_off.hpp"
#include "daemon/source/port.hpp"
#include "protocol/text/catalogue.hpp"

namespace a351::daemon::source {
namespace {

using journal::OvenOutcome;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// Shortest poll interval, real time.  An answer at 9600 baud takes about 60 ms.
constexpr milliseconds kShortestRealInterval{100};
// Pause between an answer and the next request: at least 2 ms by H175-E1, section 2.
constexpr milliseconds kPause{10};
// Modbus Application Protocol V1.1b3, section 7.
constexpr std::uint8_t kIllegalDataAddress = 2;
constexpr int kPollsUntilStale = 3;
constexpr int kDecimalTries = 3;

OvenLinkStatus::State state_after(OvenOutcome outcome) {
    using State = OvenLinkStatus::State;
    return outcome == OvenOutcome::answered    ? State::answering
           : outcome == OvenOutcome::no_port   ? State::searching
           : outcome == OvenOutcome::timed_out ? State::silent
                                               : State::disturbed;
}

}  // namespace

const char* to_text(OvenLinkStatus::State state) noexcept {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("searching"), text::marked("silent"),
                                text::marked("disturbed"), text::marked("answering")};
    return kTexts.at(static_cast<std::size_t>(state));
}

std::map<std::string, std::uint64_t> polls_by_outcome(const OvenLinkStatus& status) {
    // In the order of the enumerators.
    constexpr std::array<const char*, journal::kOvenOutcomeCount> kTexts{
        "answered", "timed_out", "bad_crc", "exception", "other_unit", "malformed", "no_port"};
    std::map<std::string, std::uint64_t> polls;
    for (std::size_t i = 0; i < kTexts.size(); ++i) polls[kTexts[i]] = status.polls[i];
    return polls;
}

std::chrono::seconds archived_interval(const OvenLinkOptions& options, const HostClock& clock) {
    const auto interval =
        std::max(options.poll_interval, clock.instrument_span(kShortestRealInterval));
    return std::clamp(std::chrono::ceil<seconds>(interval), journal::kShortestOvenInterval,
                      journal::kLongestOvenInterval);
}

OvenLink::OvenLink(OvenLinkOptions options, const HostClock& clock, Hook hook)
    : options_(std::move(options)),
      clock_(clock),
      hook_(std::move(hook)),
      real_interval_(
          std::max<Nanoseconds>(kShortestRealInterval, clock.real_span(options_.poll_interval))),
      // A poll can last until its time-out, which is in real time.
      stale_after_(
          kPollsUntilStale *
          std::max(options_.poll_interval,
                   clock.instrument_span(kShortestRealInterval + ModbusLine::kResponseTimeout))),
      decimals_(options_.decimals) {}

void OvenLink::stop() {
    std::unique_lock lock(mutex_);
    stop_ = true;
    lock.unlock();
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

OvenLinkStatus OvenLink::status() const {
    const std::lock_guard lock(mutex_);
    OvenLinkStatus status = status_;
    const RawTime now = clock_.raw();
    if (answered_at_) status.age = now - *answered_at_;
    status.is_stale = is_stale(now);
    return status;
}

bool OvenLink::is_stale(RawTime now) const {
    return !answered_at_ || now - *answered_at_ > stale_after_;
}

void OvenLink::run() noexcept {
    auto due = steady_clock::now();  // A late poll does not delay the next one.
    while (!stop_) {
        bool is_answered = false;
        try {
            is_answered = poll();
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            status_.trouble = error.what();
        }
        if (is_answered) {
            failures_in_a_row_ = 0;
            due = std::max<steady_clock::time_point>(due + real_interval_,
                                                     steady_clock::now() + kPause);
        } else {
            line_.reset();
            due = steady_clock::now() + real_wait_of(clock_, back_off_of(failures_in_a_row_++));
        }
        std::unique_lock lock(mutex_);
        woken_.wait_until(lock, due, [this] { return stop_.load(); });
    }
    line_.reset();
}

bool OvenLink::poll() {
    ModbusLine::Answer answer = read_monitors();
    journal::OvenChunk poll{clock_.raw(), answer.outcome, 0, std::move(answer.words)};
    const bool is_answered = answer.outcome == OvenOutcome::answered;
    if (is_answered && !stop_) ask_decimals();
    poll.decimals = static_cast<std::uint8_t>(decimals_);
    poll.place = options_.place;
    note(poll, answer.trouble);
    hook_(std::move(poll));
    return is_answered;
}

ModbusLine::Answer OvenLink::read_monitors() {
    try {
        if (!line_) {
            line_ = std::make_unique<ModbusLine>(options_.line);
            is_four_byte_ = false;
            decimal_tries_left_ = kDecimalTries;
            const std::lock_guard lock(mutex_);
            status_.port = line_->description();
        }
        ModbusLine::Answer answer = read_variables(oven::kFirstMonitor, oven::kMonitorCount);
        if (answer.exception != kIllegalDataAddress || is_four_byte_ || stop_) return answer;
        is_four_byte_ = true;
        std::this_thread::sleep_for(kPause);
        ModbusLine::Answer other = read_variables(oven::kFirstMonitor, oven::kMonitorCount);
        if (other.outcome == OvenOutcome::answered) return other;
        is_four_byte_ = false;
        return answer;
    } catch (const PortError& error) {
        return {OvenOutcome::no_port, {}, error.what()};
    }
}

// In four-byte mode the low words hold the values of two-byte mode.
ModbusLine::Answer OvenLink::read_variables(oven::Address first, std::size_t count) {
    if (!is_four_byte_) return line_->read(first.two_byte, count);
    ModbusLine::Answer answer = line_->read(first.four_byte, 2 * count);
    if (answer.outcome != OvenOutcome::answered) return answer;
    for (std::size_t i = 0; i < count; ++i) answer.words[i] = answer.words[2 * i + 1];
    answer.words.resize(count);
    return answer;
}

// Only a controller that answers is asked, so that a silent one costs one time-out only.  If it
// does not report its decimals, its other values are still used.
void OvenLink::ask_decimals() {
    if (decimal_tries_left_ == 0) return;
    --decimal_tries_left_;
    std::this_thread::sleep_for(kPause);
    const ModbusLine::Answer answer = read_variables(oven::kDecimalPoint, 1);
    const bool is_answered = answer.outcome == OvenOutcome::answered;
    // A model that has no such register answers with an exception.
    if (!is_answered && answer.outcome != OvenOutcome::exception) return;
    decimal_tries_left_ = 0;
    const bool is_known = is_answered && answer.words.front() <= oven::kMostDecimals;
    decimals_ = is_known ? answer.words.front() : options_.decimals;
}

void OvenLink::note(const journal::OvenChunk& poll, const std::string& trouble) {
    const std::lock_guard lock(mutex_);
    ++status_.polls.at(static_cast<std::size_t>(poll.outcome));
    status_.trouble = trouble;
    if (poll.outcome == OvenOutcome::no_port) status_.port.clear();
    if (poll.outcome == OvenOutcome::answered) {
        answered_at_ = poll.time;
        status_.decimals = poll.decimals;
        status_.values = oven::controller_values(poll.registers, poll.decimals);
    } else if (poll.outcome != OvenOutcome::no_port && !is_stale(poll.time)) {
        return;  // One lost answer does not change the state.
    }
    status_.state = state_after(poll.outcome);
}

}  // namespace a351::daemon::source
