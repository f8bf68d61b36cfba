#include "daemon/source/sensor_link.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "daemon/source/handshake_driver.hpp"
#include "daemon/source/step_watch.hpp"
#include "protocol/timing/host_clock_rules.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/commands.hpp"

namespace a351::daemon {
namespace {

using std::chrono::ceil;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// A busy host pauses this long without anything being wrong.
constexpr milliseconds kShortestRealStall{1000};
constexpr milliseconds kShortestRealWait{50};
// Of instrument time.
constexpr seconds kSilenceIsStall{2};
constexpr seconds kBabbleIsStall{3};
constexpr milliseconds kStopCheck{200};
constexpr milliseconds kQueueRetry{10};
constexpr seconds kPortRetry{1};
constexpr milliseconds kSilence{50};
constexpr seconds kLongestDrain{1};
constexpr std::array kHandshakeBackOff{seconds(1), seconds(2), seconds(5), seconds(10),
                                       seconds(30)};

/// The configured rate, then the others that carry the frames.
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

record::SessionId random_session() {
    std::random_device source;
    record::SessionId id;
    for (std::uint8_t& byte : id.bytes) byte = static_cast<std::uint8_t>(source());
    return id;
}

}  // namespace

const char* to_text(LinkStatus::State state) noexcept {
    switch (state) {
        case LinkStatus::State::searching:
            return "searching";
        case LinkStatus::State::handshake:
            return "handshake";
        case LinkStatus::State::sampling:
            return "sampling";
        case LinkStatus::State::waiting:
            return "waiting";
        case LinkStatus::State::stopped:
            return "stopped";
    }
    return "";
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
    const auto last = std::find(bauds_.begin(), bauds_.end(), known_->header.baud);
    if (last != bauds_.end()) std::rotate(bauds_.begin(), last, bauds_.end());
}

SensorLink::~SensorLink() { stop(); }

void SensorLink::start() {
    try {
        open();
    } catch (const PortError& error) {
        if (error.kind() == PortError::Kind::locked) throw;
    }
    thread_ = std::thread([this] { run(); });
}

void SensorLink::stop() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

LinkStatus SensorLink::status() const {
    const std::lock_guard lock(mutex_);
    LinkStatus status = status_;
    status.queue_full = queue_full_;
    status.is_held_up = is_held_up_;
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
    set_state(LinkStatus::State::stopped, "stopped");
}

void SensorLink::open() {
    port_ = open_port(options_.address, bauds_.front());
    is_port_new_ = true;
}

bool SensorLink::find_port() {
    try {
        if (!port_) open();
    } catch (const PortError& error) {
        set_state(LinkStatus::State::searching, error.what());
        return false;
    }
    const std::lock_guard lock(mutex_);
    status_.port = port_->description();
    status_.baud = bauds_.front();
    return true;
}

// A stream that goes on after an outage, of the port or of this program, is not touched: its
// counter tells what the outage cost.
bool SensorLink::adopt() {
    if (!std::exchange(is_port_new_, false) || !known_) return false;
    record::JournalHeader expected = options_.header;
    expected.baud = bauds_.front();
    const record::JournalHeader& last = known_->header;
    const bool is_expected_device = options_.expected_serial_number.empty() ||
                                    options_.expected_serial_number == last.serial_number;
    if (!is_same_stream(last, expected) || last.port != expected.port || !is_expected_device)
        return false;
    set_state(LinkStatus::State::handshake, "listening for a stream that goes on");
    const Listening listening = listen_for(*known_, *port_, clock_, stop_);
    if (listening.outcome == Listening::Outcome::port_gone) lose_port();
    if (listening.outcome != Listening::Outcome::goes_on) return false;
    continue_session(listening.reads);
    return true;
}

void SensorLink::continue_session(const std::vector<Heard>& reads) {
    begun_ = Begun{options_.header, {}};
    record::JournalHeader& header = begun_->header;
    const record::JournalHeader& last = known_->header;
    header.session = last.session;
    header.product_id = last.product_id;
    header.serial_number = last.serial_number;
    header.firmware = last.firmware;
    header.is_device_assumed = true;
    header.baud = bauds_.front();
    header.clock = clock_.read();
    {
        const std::lock_guard lock(mutex_);
        status_.device = {.product_id = last.product_id,
                          .serial_number = last.serial_number,
                          .firmware = last.firmware,
                          .has_expected_product_id =
                              last.product_id.starts_with(options_.profile->product_id_prefix)};
        status_.is_device_assumed = true;
        ++status_.adoptions;
    }
    begin_session();
    for (const Heard& read : reads) push(ReadQueue::Kind::rx, read.time, read.bytes);
}

bool SensorLink::begin_sampling() {
    if (!port_) return false;
    set_state(LinkStatus::State::handshake, "configuring the sensor");
    wire::Handshake handshake(*options_.profile, options_.settings,
                              options_.expected_serial_number);
    HandshakeRun run = run_handshake(handshake, *port_, clock_, stop_);
    if (stop_) return false;
    if (std::holds_alternative<PortGone>(run.outcome)) {
        lose_port();
        return false;
    }
    if (const auto* const device = std::get_if<wire::DeviceIdentity>(&run.outcome)) {
        bauds_tried_ = 0;
        take_up(*device, std::move(run.sent));
        return true;
    }
    const auto& failure = std::get<wire::HandshakeFailure>(run.outcome);
    {
        const std::lock_guard lock(mutex_);
        ++status_.handshake_failures;
    }
    // A sensor that was just switched on is silent for a second: it is asked again first.
    const bool may_be_baud =
        failure.is_unanswered && (run.bytes_passed_over > 0 || failures_in_a_row_ > 0);
    if (may_be_baud && try_next_baud()) return false;
    bauds_tried_ = 0;
    std::string trouble = failure.reason;
    if (failure.is_unanswered && run.bytes_passed_over > 0)
        trouble += "; bytes come, but nothing that can be understood at any baud rate";
    back_off(trouble);
    return false;
}

/// @return false when every one has been tried; then the first one is in force again.
bool SensorLink::try_next_baud() {
    std::rotate(bauds_.begin(), bauds_.begin() + 1, bauds_.end());
    port_.reset();  // Opened anew by find_port().
    return ++bauds_tried_ < bauds_.size();
}

void SensorLink::take_up(const wire::DeviceIdentity& device, std::vector<record::TxChunk> sent) {
    begun_ = Begun{options_.header, std::move(sent)};
    record::JournalHeader& header = begun_->header;
    header.session = random_session();
    header.product_id = device.product_id;
    header.serial_number = device.serial_number;
    header.firmware = device.firmware;
    header.baud = bauds_.front();
    header.clock = clock_.read();
    const std::lock_guard lock(mutex_);
    status_.device = device;
    status_.is_device_assumed = false;
}

void SensorLink::back_off(const std::string& trouble) {
    set_state(LinkStatus::State::waiting, trouble);
    wait(kHandshakeBackOff[std::min(failures_in_a_row_, kHandshakeBackOff.size() - 1)]);
    ++failures_in_a_row_;
}

void SensorLink::begin_session() {
    const timing::ClockReading& told = begun_->header.clock;
    slept_ = told.boottime - told.raw.time_since_epoch();
    const bool is_new = !known_ || known_->header.session != begun_->header.session;
    // The counter of a device that was just configured starts at 0.
    if (is_new) known_ = record::StreamEnd{begun_->header, 0, begun_->header.clock.raw};
    while (!queue_.push_session(begun_->header, begun_->header.clock.raw) && !stop_) hold_up();
    is_held_up_ = false;
    for (const record::TxChunk& chunk : begun_->sent) {
        push(ReadQueue::Kind::tx, chunk.time, chunk.bytes);
    }
    begun_.reset();

    const std::lock_guard lock(mutex_);
    status_.state = LinkStatus::State::sampling;
    status_.trouble.clear();
    if (is_new) ++status_.sessions;
}

SensorLink::End SensorLink::read_stream() {
    const auto at_least_real = [this](Nanoseconds instrument_span) {
        return std::max<Nanoseconds>(kShortestRealStall, clock_.real_span(instrument_span));
    };
    const auto frame_period = from_seconds(1.0 / options_.settings.output_rate_hz);
    const auto silence = at_least_real(std::max<Nanoseconds>(kSilenceIsStall, 20 * frame_period));
    const auto babble = at_least_real(kBabbleIsStall);

    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    // Only to see that frames come, and at what rate; the archive has its own decoder.
    const auto count_step = options_.profile->count_step(options_.settings.output_rate_hz);
    wire::BurstDecoder decoder(options_.settings.layout, count_step);
    StepWatch watch(count_step);
    auto last_byte = steady_clock::now();
    auto last_frame = last_byte;
    has_frames_ = false;
    while (!stop_) {
        const auto count = port_->read(bytes, kStopCheck);
        RawTime time = clock_.raw();
        if (!count) return End::gone;
        const auto now = steady_clock::now();
        if (*count > 0) {
            std::span<const std::byte> input = std::span(bytes).first(*count);
            if (begun_) begin_session();
            const Nanoseconds slept_before = std::exchange(slept_, clock_.slept());
            if (slept_ - slept_before > timing::kShortestSleep) time = push_woken();
            push(ReadQueue::Kind::rx, time, input);
            last_byte = now;
            while (const auto event = decoder.next(input)) {
                const auto* frame = std::get_if<wire::BurstFrame>(&*event);
                if (frame == nullptr) continue;
                if (options_.settings.layout.has_count() && watch.is_altered(frame->values().count))
                    return End::altered;
                known_->count = frame->values().count;
                known_->arrival = time;
                last_frame = now;
                failures_in_a_row_ = 0;
                has_frames_ = true;
            }
        }
        if (now - last_byte > silence) return End::stalled;
        if (now - last_frame > std::max(babble, silence)) return End::unframed;
    }
    return End::stopped;
}

// A sensor that worked is configured again at once; one that answers but sends nothing of use
// would otherwise begin session after session.
void SensorLink::note_stall(End end) {
    const std::string trouble = end == End::stalled    ? "no bytes from the sensor"
                                : end == End::unframed ? "bytes but no frames"
                                                       : "the sensor's rate was changed";
    {
        const std::lock_guard lock(mutex_);
        ++status_.stalls;
    }
    if (has_frames_) return set_state(LinkStatus::State::handshake, trouble);
    back_off(trouble);
}

// A full queue holds the reader up: what the kernel cannot keep meanwhile is lost on a real port,
// seen as a gap and counted here; the writer of a pseudo-terminal is held up in turn.
void SensorLink::push(ReadQueue::Kind kind, RawTime time, std::span<const std::byte> bytes) {
    while (!queue_.push(kind, time, bytes)) {
        if (stop_) return;
        hold_up();
    }
    is_held_up_ = false;
}

/// After a sleep of the host, before the first bytes that follow it.  @return  when they came, by
/// a clock that tells of the sleep: the journal may be written much later, after another sleep.
RawTime SensorLink::push_woken() {
    const timing::ClockReading reading = clock_.read();
    while (!queue_.push_woken(reading) && !stop_) hold_up();
    is_held_up_ = false;
    return reading.raw;
}

void SensorLink::hold_up() {
    ++queue_full_;
    is_held_up_ = true;
    std::this_thread::sleep_for(kQueueRetry);
}

void SensorLink::stop_sensor() {
    if (!port_) return;
    const bool is_recorded = status().state == LinkStatus::State::sampling;
    for (const auto& command : wire::stop_sampling()) {
        const RawTime sent = clock_.raw();
        if (!port_->write(command)) return;
        if (is_recorded) push(ReadQueue::Kind::tx, sent, command);
        std::this_thread::sleep_for(wire::kCommandSpacing);
    }
    if (!is_recorded) return;

    // Frames that are on their way belong to the session.
    std::array<std::byte, ReadQueue::kLargestItem> bytes{};
    const auto end = steady_clock::now() + kLongestDrain;
    while (steady_clock::now() < end) {
        const auto count = port_->read(bytes, kSilence);
        if (count.value_or(0) == 0) return;
        push(ReadQueue::Kind::rx, clock_.raw(), std::span(bytes).first(*count));
    }
}

void SensorLink::lose_port() {
    port_.reset();
    set_state(LinkStatus::State::searching, options_.address.to_text() + ": the port is gone");
    {
        const std::lock_guard lock(mutex_);
        status_.port.clear();
        ++status_.ports_lost;
    }
    wait(kPortRetry);
}

void SensorLink::wait(seconds instrument_span) {
    const auto real =
        std::max<Nanoseconds>(kShortestRealWait, clock_.real_span(Nanoseconds(instrument_span)));
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, real, [this] { return stop_.load(); });
}

void SensorLink::set_state(LinkStatus::State state, std::string trouble) {
    const std::lock_guard lock(mutex_);
    status_.state = state;
    status_.trouble = std::move(trouble);
}

}  // namespace a351::daemon
