#include "daemon/store/decoder.hpp"

#include <fmt/core.h>

#include <utility>
#include <variant>

namespace a351::daemon::store {
namespace {

constexpr std::chrono::seconds kModelInterval{10};                // Instrument time, and
constexpr std::chrono::milliseconds kShortestModelInterval{100};  // real time.
constexpr std::size_t kSessionsRemembered = 8;  // Each has 24 h of times, up to 3.5 MB.

std::optional<survey::Instant> instant_of(const journal::SessionId& session,
                                          const timing::SampleClock& clock,
                                          std::optional<std::int64_t> index) {
    const auto time = index ? clock.time_of(*index) : std::nullopt;
    return time ? std::optional(survey::Instant{session, *index, time->utc}) : std::nullopt;
}

}  // namespace

Decoder::Decoder(const Options& options, const source::HostClock& clock, WaitingRecords& records,
                 Progress& progress, JournalThread& journal)
    : options_(options),
      clock_(clock),
      records_(records),
      progress_(progress),
      journal_(journal),
      archiver_(std::make_unique<archive::Archiver>(*this)) {}

void Decoder::begin_replay() {
    const std::lock_guard lock(mutex_);
    archiver_ = std::make_unique<archive::Archiver>(*this);
    archive_ = nullptr;
    session_.reset();
    ended_.clear();
}

void Decoder::replay_into(const archive::Writer& archive) {
    const std::lock_guard lock(mutex_);
    archive_ = &archive;
}

bool Decoder::replay(const journal::Chunk& chunk) {
    const std::lock_guard lock(mutex_);
    const bool is_next_session = begin_session(chunk);
    archiver_->take(chunk);
    return is_next_session;
}

std::optional<journal::SessionId> Decoder::end_replay(archive::Writer::Held held) {
    const std::lock_guard lock(mutex_);
    archive_ = nullptr;
    held_ = std::move(held);
    record_session_ = session_;
    status_.counters = archiver_->counters();
    const UtcTime now = clock_.read().realtime;  // Samples may be an hour away.
    if (is_back(now)) expect_step({*newest_, now});
    return session_;
}

void Decoder::take(const NumberedChunk& numbered) {
    const std::lock_guard lock(mutex_);
    watch_clock(numbered.chunk);
    const bool is_header = std::holds_alternative<journal::Header>(numbered.chunk);
    if (const auto* const header = std::get_if<journal::Header>(&numbered.chunk))
        watch_sensor(*header);
    has_recorded_ |= is_header;
    const bool is_next_session = begin_session(numbered.chunk);
    if (is_next_session) last_sample_.reset();
    chunk_ = numbered.number;
    archiver_->take(numbered.chunk);
    watch_rate(numbered.chunk);
    if (is_next_session) held_.clear();  // Not before: the last session's records end now.
    if (is_header) record_session_ = session_;
    status_.counters = archiver_->counters();
    status_.last_sample = last_sample_;
    if (record_session_)
        progress_.parsed(numbered.number, *record_session_, archiver_->last_index());
    note_model();
}

/// Begins a session if the chunk is the header of one.  @return false if none begins.
bool Decoder::begin_session(const journal::Chunk& chunk) {
    const auto* const header = std::get_if<journal::Header>(&chunk);
    if (header == nullptr || session_ == header->session) return false;
    serial_number_ = header->serial_number;
    start_up_test_ = header->start_up_test;
    const auto ended = std::exchange(session_, header->session);
    if (const auto last_index = archiver_->last_index(); ended && last_index)
        ended_.push_back({*ended, *archiver_->clock(), *last_index, rate_});
    rate_ = Hertz(header->output_rate_hz);
    if (ended_.size() > kSessionsRemembered) ended_.pop_front();
    return true;
}

void Decoder::watch_clock(const journal::Chunk& chunk) {
    const auto* const header = std::get_if<journal::Header>(&chunk);
    const auto* const reading =
        header != nullptr ? &header->clock : std::get_if<timing::ClockReading>(&chunk);
    const auto step = reading != nullptr ? clock_watch_.observe(*reading) : std::nullopt;
    if (step) expect_step(*step);
}

void Decoder::watch_rate(const journal::Chunk& chunk) {
    if (const auto* const header = std::get_if<journal::Header>(&chunk)) {
        rate_watch_.emplace(header->output_rate_hz);
        status_.wrong_rate.reset();
    }
    const auto* const received = std::get_if<journal::RxChunk>(&chunk);
    const auto index = archiver_->last_index();
    if (!rate_watch_ || !index || received == nullptr || received->reads.empty()) return;
    rate_watch_->take(*index, received->reads.back().time);
    status_.wrong_rate = rate_watch_->wrong_rate();
}

/// Returns true if this time is before that of the newest sample.
bool Decoder::is_back(UtcTime utc) const { return newest_ && utc + survey::kLeastBack < *newest_; }

/// Notes a step before a sample shows it.
void Decoder::expect_step(const status::ClockStep& step) {
    note_step(step);
    if (const Nanoseconds by = step.after - step.before; by < -survey::kLeastBack) expected_ = by;
}

/// Takes the time of the next sample.  If it is before that of the newest one and no noted step
/// explains this, the clock was set back while nothing was recorded, or while the host slept.
/// @param is_first  it is the first sample of a session.
void Decoder::watch_time(UtcTime utc, bool is_first) {
    if (is_back(utc)) {
        const Nanoseconds by = utc - *newest_;
        if (const auto expected = std::exchange(expected_, std::nullopt);
            !expected || by < *expected - survey::kLeastBack) {
            note_step({*newest_, utc});
            clock_watch_ = {};  // It would report the same step a minute later.
        }
    } else if (is_first) {
        expected_.reset();  // The clock was set right before the sensor began.
    }
    newest_ = utc;
}

void Decoder::note_step(const status::ClockStep& step) {
    status_.clock_step = step;
    events::Event event;
    event.type = "clock_step";
    event.utc = step.after;
    event.details["clock_before"] = to_rfc3339(step.before, 3);
    event.details["clock_after"] = to_rfc3339(step.after, 3);
    event.details["by_s"] = fmt::format("{:+.3f}", seconds_between(step.before, step.after));
    journal_.note(event);
}

/// Reports that another sensor records: the last sample of the one before ends its stay.
void Decoder::report_other_unit(const journal::Header& header) {
    if (header.clock.realtime < day_end_.load())
        status_.unit_change = {header.clock.realtime, serial_number_, header.serial_number};
    events::Event event;
    event.type = "other_unit";
    event.utc = header.clock.realtime;
    if (const auto last = last_instant()) {
        event.utc = last->utc;
        event.session = last->session;
        event.index = last->index;
    }
    event.details["before"] = serial_number_;
    event.details["serial_number"] = header.serial_number;
    options_.other_unit(event);
}

void Decoder::watch_sensor(const journal::Header& header) {
    const bool is_other = !serial_number_.empty() && header.serial_number != serial_number_;
    if (is_other) report_other_unit(header);
    // The same sensor does not sample any more: its power was interrupted, or its line was disturbed.
    const bool is_again = has_recorded_ && header.session != session_ && !is_other;
    if (is_again && !header.is_device_assumed) status_.started_again = header.clock.realtime;
    if (header.start_up_test == start_up_test_ && !is_other) return;
    events::Event event;
    event.type = "start_up_test";
    event.utc = header.clock.realtime;
    event.session = header.session;
    event.details["result"] = wire::to_text(header.start_up_test);
    event.details["serial_number"] = header.serial_number;
    journal_.note(event);
}

void Decoder::note_model() {
    const auto now = options_.time.now();
    if (now - last_model_real_ < kShortestModelInterval) return;
    const RawTime raw = clock_.raw();
    if (raw - last_model_ < kModelInterval) return;
    const auto index = archiver_->last_index();
    const auto time = index ? archiver_->clock()->time_of(*index) : std::nullopt;
    if (!time) return;
    last_model_ = raw;
    last_model_real_ = now;
    journal_.push(0, journal::ModelChunk{*index, *time});
}

void Decoder::close_records() {
    const std::lock_guard lock(mutex_);
    archiver_->close_records();
}

void Decoder::end_run() {
    const std::lock_guard lock(mutex_);
    if (!has_recorded_ || archiver_->are_times_fixed()) archiver_->close_records();
}

void Decoder::record(const std::string& channel, const archive::PackedRecord& record,
                     std::int64_t last_index) {
    records_.push({chunk_, record_session_, channel, record, last_index});
}

void Decoder::sample(const archive::Sample& sample) {
    const bool is_first = !last_sample_;
    last_sample_ = sample;
    const auto placed = archiver_->clock()->time_of(sample.index);
    if (!placed) return;
    options_.sample(sample, placed->utc);
    if (archive_ == nullptr)
        watch_time(placed->utc, is_first);
    else
        newest_ = placed->utc;  // The last run has noted its own steps.
}

std::optional<std::size_t> Decoder::samples_in_archive(const std::string& channel,
                                                       UtcTime start) const {
    if (archive_ != nullptr) return archive_->samples_in_archive(channel, start);
    const auto records = held_.find(channel);
    if (records == held_.end()) return std::nullopt;
    const auto record = records->second.find(start);
    return record == records->second.end() ? std::nullopt : std::optional(record->second);
}

std::optional<survey::Instant> Decoder::latest() const {
    const std::lock_guard lock(mutex_);
    return last_instant();
}

/// Returns the last sample.  The lock is held.
std::optional<survey::Instant> Decoder::last_instant() const {
    if (const auto index = archiver_->last_index(); index && session_)
        return instant_of(*session_, *archiver_->clock(), index);
    if (ended_.empty()) return std::nullopt;
    return instant_of(ended_.back().session, ended_.back().clock, ended_.back().last_index);
}

std::optional<survey::Instant> Decoder::at(UtcTime utc) const {
    const std::lock_guard lock(mutex_);
    for (const Ended& one : ended_)
        if (const auto found = instant_of(one.session, one.clock, one.clock.index_at(utc)))
            return found;
    const timing::SampleClock* const clock = archiver_->clock();
    if (clock == nullptr || !session_) return std::nullopt;
    return instant_of(*session_, *clock, clock->index_at(utc));
}

Nanoseconds Decoder::signal_since(const journal::SessionId& session, std::int64_t index) const {
    const std::lock_guard lock(mutex_);
    Nanoseconds signal{0};
    const auto add = [&](const journal::SessionId& of, std::int64_t last_index, Hertz rate) {
        const bool is_first = of == session;
        if (is_first) signal = Nanoseconds(0);
        // A smaller last index means that the sensor's counter began again at 0.
        const bool is_counted_from_it = is_first && index <= last_index;
        signal += timing::SamplePeriod(rate).of(last_index - (is_counted_from_it ? index : -1));
    };
    for (const Ended& one : ended_) add(one.session, one.last_index, one.rate);
    if (const auto last_index = archiver_->last_index(); last_index && session_)
        add(*session_, *last_index, rate_);
    return signal;
}

Decoder::Status Decoder::status() const {
    const std::lock_guard lock(mutex_);
    Status status = status_;
    if (const timing::SampleClock* const clock = archiver_->clock()) {
        status.timing_state = clock->state();
        status.timing_uncertainty = clock->uncertainty();
        status.host_uncertainty = clock->host_uncertainty();
        status.is_host_synchronised = clock->is_host_synchronised();
        status.measured_rate = clock->measured_rate();
    }
    return status;
}

}  // namespace a351::daemon::store
