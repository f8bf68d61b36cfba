#include "daemon/source/sensor_link.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <random>
#include <utility>

#include "daemon/source/back_off.hpp"
#include "protocol/wire/commands.hpp"

namespace a351::daemon::source {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Waiting times in instrument time, which real_wait() converts.
constexpr seconds kPortRetry{1};
// Bytes of another device.  The shortest line of a GPS receiver, which sends lines each second, has
// 20: "$GPGLL,,,,,,V,N*64" and its end (NMEA 0183).  A plug that is put in makes a few.
constexpr std::size_t kLeastTalk = 16;

/// Returns the configured rate, then the other rates that are fast enough for the frames.
std::vector<int> bauds_of(const LinkOptions& options) {
    std::vector<int> bauds{options.baud};
    const auto frame_bits = static_cast<int>(10 * options.settings.layout.frame_size());  // 8N1
    for (const auto& coded : options.profile->baud_rates) {
        if (coded.value != options.baud &&
            coded.value >= frame_bits * options.settings.output_rate_hz)
            bauds.push_back(coded.value);
    }
    return bauds;
}

journal::SessionId random_session() {
    std::random_device source;
    journal::SessionId id;
    for (std::uint8_t& byte : id.bytes) byte = static_cast<std::uint8_t>(source());
    return id;
}

}  // namespace

const char* to_text(LinkStatus::State state) noexcept {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("searching"), text::marked("handshake"),
                                text::marked("sampling"), text::marked("waiting"),
                                text::marked("stopped")};
    return kTexts.at(static_cast<std::size_t>(state));
}

SensorLink::SensorLink(LinkOptions options, const HostClock& clock, ReadQueue& queue)
    : options_(std::move(options)),
      clock_(clock),
      queue_(queue),
      bauds_(bauds_of(options_)),
      known_(options_.known) {
    options_.header.port = options_.address.to_text();
    status_.baud = status_.configured_baud = options_.baud;
    if (!known_) return;
    status_.start_up_test = known_->header.start_up_test;
    const auto last = std::find(bauds_.begin(), bauds_.end(), known_->header.baud);
    if (last != bauds_.end()) std::rotate(bauds_.begin(), last, bauds_.end());
}

void SensorLink::start() {
    try {
        open();
    } catch (const PortError& error) {
        if (error.kind() == PortError::Kind::locked) throw;
    }
    thread_ = std::thread([this] { run(); });
}

void SensorLink::stop() {
    std::unique_lock lock(mutex_);
    stop_ = true;
    lock.unlock();
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

LinkStatus SensorLink::status() const {
    const std::lock_guard lock(mutex_);
    LinkStatus status = status_;
    status.queue_full = queue_full_;
    status.waits_for_journal = waits_for_journal_;
    return status;
}

void SensorLink::run() noexcept {
    while (!stop_) {
        try {
            if (!find_port()) {
                wait(kPortRetry);
            } else if (adopt() || begin_sampling()) {
                const End end = read_stream();
                if (end == End::gone)
                    lose_port();
                else if (end != End::stopped)
                    note_stall(end);
            }
        } catch (const std::exception& error) {
            set_state(LinkStatus::State::waiting, error.what());
            wait(kPortRetry);
        }
    }
    stop_sensor();
    port_.reset();
    set_state(LinkStatus::State::stopped, text::message("stopped"));
}

void SensorLink::open() {
    port_ = options_.open(options_.address, bauds_.front());
    may_continue_ = true;
    was_open_ = true;
}

bool SensorLink::find_port() {
    try {
        if (!port_) open();
    } catch (const PortError& error) {
        const bool is_unplugged = was_open_ && error.kind() == PortError::Kind::absent;
        set_state(LinkStatus::State::searching, is_unplugged ? unplugged() : error.what());
        return false;
    }
    const std::lock_guard lock(mutex_);
    status_.port = port_->description();
    status_.baud = bauds_.front();
    return true;
}

// A stream that continues after an outage of the port, of the line or of this program is not
// touched: its counter shows how many samples the outage cost.
bool SensorLink::adopt() {
    const std::vector<Read> unread = std::exchange(unread_, {});
    if (!std::exchange(may_continue_, false) || !known_) return false;
    journal::Header expected = options_.header;
    expected.baud = bauds_.front();
    const journal::Header& last = known_->header;
    const bool is_expected_device = options_.expected_serial_number.empty() ||
                                    options_.expected_serial_number == last.serial_number;
    if (!journal::is_same_stream(last, expected) || last.port != expected.port ||
        !is_expected_device)
        return false;
    set_state(LinkStatus::State::handshake,
              text::message("checking whether the sensor is still sampling"));
    const Listening listening = listen_for(*known_, unread, *port_, clock_, stop_);
    is_silent_ = listening.reads.empty();
    if (listening.outcome == Listening::Outcome::port_gone) lose_port();
    if (listening.outcome != Listening::Outcome::continues) return false;
    prepare_session(last.session,
                    {.product_id = last.product_id,
                     .serial_number = last.serial_number,
                     .firmware = last.firmware,
                     .has_expected_product_id =
                         last.product_id.starts_with(options_.profile->product_id_prefix)},
                    true, {});
    begin_session();
    for (const Read& read : listening.reads) push(ReadQueue::Kind::rx, read.time, read.bytes);
    return true;
}

bool SensorLink::begin_sampling() {
    if (!port_) return false;
    // The reason of a failure stays while the sensor is asked again.
    if (failures_in_a_row_ == 0)
        set_state(LinkStatus::State::handshake, text::message("configuring the sensor"));
    if (!is_configurable()) return false;
    wire::Handshake handshake(*options_.profile, options_.settings, options_.expected_serial_number,
                              status().start_up_test);
    HandshakeRun run = run_handshake(handshake, *port_, clock_, stop_);
    {
        const std::lock_guard lock(mutex_);
        status_.start_up_test = handshake.start_up_test();
    }
    if (stop_) return false;
    if (std::holds_alternative<PortGone>(run.outcome)) {
        lose_port();
        return false;
    }
    if (const auto* const device = std::get_if<wire::DeviceIdentity>(&run.outcome)) {
        bauds_tried_ = 0;
        prepare_session(random_session(), *device, false, std::move(run.sent));
        return true;
    }
    handle_failure(std::get<wire::HandshakeFailure>(run.outcome), run.bytes_skipped);
    return false;
}

/// Makes sure that no stream begins again on a line that was silent: a command would stop it.
/// @return true if the sensor may be configured.
bool SensorLink::is_configurable() {
    if (!is_silent_ || !known_) return true;
    Probe probe = probe_silent_line(*port_, clock_, stop_);
    switch (probe.outcome) {
        case Probe::Outcome::stopped:
            return true;
        case Probe::Outcome::heard:
            expect_stream(std::move(probe.reads));
            break;
        case Probe::Outcome::port_gone:
            lose_port();
            break;
        case Probe::Outcome::silent:
            handle_failure({.reason = "", .is_unanswered = true}, 0);
            break;
    }
    return false;
}

void SensorLink::handle_failure(const wire::HandshakeFailure& failure, std::size_t bytes_skipped) {
    {
        const std::lock_guard lock(mutex_);
        ++status_.handshake_failures;
    }
    // A sensor that was just switched on is silent for a second, so it is first asked again.
    const bool may_be_baud = failure.is_unanswered && (bytes_skipped > 0 || failures_in_a_row_ > 0);
    if (may_be_baud && try_next_baud()) return;
    bauds_tried_ = 0;
    const bool is_talk = strange_bytes_ + bytes_skipped >= kLeastTalk;
    strange_bytes_ = 0;  // Noise of hours is no talk.
    if (!failure.is_unanswered)
        back_off(text::marked_message(failure.reason));
    else if (is_talk)
        back_off(
            text::message("bytes arrive, but none can be understood at any baud rate: another "
                          "device, such as a GPS receiver; check sensor.port"));
    else
        back_off(text::message("the sensor does not answer; check its plug and its power"));
}

/// Selects the next baud rate.  @return false when all have been tried; the first is then in use.
bool SensorLink::try_next_baud() {
    std::rotate(bauds_.begin(), bauds_.begin() + 1, bauds_.end());
    port_.reset();  // find_port() opens it again.
    return ++bauds_tried_ < bauds_.size();
}

void SensorLink::prepare_session(const journal::SessionId& session,
                                 const wire::DeviceIdentity& device, bool is_adopted,
                                 std::vector<journal::TxChunk> sent) {
    begun_ = Begun{options_.header, std::move(sent)};
    journal::Header& header = begun_->header;
    header.session = session;
    header.product_id = device.product_id;
    header.serial_number = device.serial_number;
    header.firmware = device.firmware;
    header.is_device_assumed = is_adopted;
    header.baud = bauds_.front();
    header.clock = clock_.read();
    const std::lock_guard lock(mutex_);
    header.start_up_test = status_.start_up_test;
    status_.device = device;
    status_.is_device_assumed = is_adopted;
    if (is_adopted) ++status_.adoptions;
}

void SensorLink::back_off(const text::Message& trouble) {
    const seconds span = back_off_of(failures_in_a_row_++);
    set_state(LinkStatus::State::waiting, trouble);
    if (find_port())  // It is closed when all baud rates have been tried.
        wait_for_bytes(real_wait(span));
    else
        wait(span);
}

/// Lets adopt() listen, at the baud rate of the known stream.
void SensorLink::expect_stream(std::vector<Read> unread) {
    is_silent_ = false;
    may_continue_ = true;
    for (const Read& read : unread) strange_bytes_ += read.bytes.size();
    unread_ = std::move(unread);
    if (!known_ || known_->header.baud == bauds_.front()) return;
    const auto last = std::find(bauds_.begin(), bauds_.end(), known_->header.baud);
    if (last == bauds_.end()) return;
    std::rotate(bauds_.begin(), last, bauds_.end());
    unread_.clear();
    port_.reset();  // find_port() opens it again.
}

void SensorLink::begin_session() {
    const timing::ClockReading& clock = begun_->header.clock;
    slept_ = clock.boottime - clock.raw.time_since_epoch();
    const bool is_new = !known_ || known_->header.session != begun_->header.session;
    // The counter of a device that was just configured starts at 0.
    if (is_new) known_ = journal::StreamEnd{begun_->header, 0, begun_->header.clock.raw};
    push_or_wait([&] { return queue_.push_session(begun_->header, begun_->header.clock.raw); });
    for (const journal::TxChunk& chunk : begun_->sent)
        push(ReadQueue::Kind::tx, chunk.time, chunk.bytes);
    begun_.reset();

    const std::lock_guard lock(mutex_);
    status_.state = LinkStatus::State::sampling;
    status_.trouble = {};
    if (is_new) ++status_.sessions;
}

// A sensor that sent frames is listened to once more and then configured at once.  One that answers
// but sends no frames is configured after a pause, because it would otherwise begin one session after
// another.
void SensorLink::note_stall(End end) {
    const text::Message trouble = end == End::stalled ? text::message("no bytes from the sensor")
                                  : end == End::unframed
                                      ? text::message("bytes arrive, but no valid frames")
                                      : text::message("the sensor's output rate has changed");
    {
        const std::lock_guard lock(mutex_);
        ++status_.stalls;
    }
    may_continue_ = is_silent_ = end == End::stalled;
    if (has_frames_) return set_state(LinkStatus::State::handshake, trouble);
    back_off(trouble);
}

/// Returns the message to the operator about a port that was there and is gone.
text::Message SensorLink::unplugged() const {
    return text::message("sensor unplugged: the port is gone ({}); plug the cable in again",
                         options_.address.to_text());
}

void SensorLink::lose_port() {
    port_.reset();
    set_state(LinkStatus::State::searching, unplugged());
    {
        const std::lock_guard lock(mutex_);
        status_.port.clear();
        ++status_.ports_lost;
    }
    wait(kPortRetry);
}

Nanoseconds SensorLink::real_wait(seconds instrument_span) const {
    return real_wait_of(clock_, instrument_span);
}

void SensorLink::wait(seconds instrument_span) {
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, real_wait(instrument_span), [this] { return stop_.load(); });
}

void SensorLink::set_state(LinkStatus::State state, text::Message trouble) {
    const std::lock_guard lock(mutex_);
    status_.state = state;
    status_.trouble = std::move(trouble);
}

}  // namespace a351::daemon::source
