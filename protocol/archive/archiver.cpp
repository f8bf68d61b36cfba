#include "protocol/archive/archiver.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/archive/arrivals.hpp"
#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/channel_packer.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/archive/slow_channels.hpp"
#include "protocol/archive/time_gate.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/invariant.hpp"
#include "protocol/timing/sample_index.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::archive {
namespace {

using wire::Axis;
using Kind = timing::Placement::Kind;

// The counter wraps every 16.4 s: up to these limits it alone determines the length of a loss.
constexpr std::uint64_t kContiguousFrames = 400;
constexpr Nanoseconds kContiguousSilence = std::chrono::seconds(10);

// Value of all axes while rate and filter do not match (M-A352AD10 data sheet, FLAG).
constexpr std::int32_t kNoData = 0x64000000;

// Bit XALARM_ERR; the alarm bits of Y and Z are the next lower ones.
constexpr unsigned kFlagAlarmX = 0x0010;

bool is_data(const wire::BurstValues& values) {
    return !(values.flag & wire::kFlagAliasing) && values.axes[0] != kNoData &&
           values.axes[1] != kNoData && values.axes[2] != kNoData;
}

const wire::DeviceProfile& profile_of(const journal::Header& header) {
    const auto* profile = wire::find_profile(header.profile);
    if (!profile) throw InputError("journal: unknown device profile '" + header.profile + "'");
    return *profile;
}

wire::BurstLayout layout_of(const journal::Header& header) {
    const auto layout = wire::BurstLayout::from_burst_ctrl(header.burst_ctrl);
    if (!layout || header.baud <= 0 || !profile_of(header).has_output_rate(header.output_rate_hz)) {
        throw InputError(
            fmt::format("journal: impossible settings: burst_ctrl {}, baud {}, output_rate_hz {}",
                        header.burst_ctrl, header.baud, header.output_rate_hz));
    }
    return *layout;
}

timing::SampleClockOptions clock_options(const journal::Header& header) {
    const auto& profile = profile_of(header);
    const auto* filter = profile.filter_named(header.filter);
    const Nanoseconds filter_delay = filter ? profile.group_delay(*filter) : Nanoseconds(0);
    return {Hertz(header.output_rate_hz),
            filter_delay + profile.data_ready_delay +
                wire_time(layout_of(header).frame_size(), header.baud)};
}

}  // namespace

class Archiver::Session {
public:
    Session(const journal::Header& header, Sink& sink, Counters& counters, Retiming* retiming)
        : header_(header),
          sink_(sink),
          counters_(counters),
          retiming_(retiming),
          layout_(layout_of(header)),
          count_step_(profile_of(header).count_step(header.output_rate_hz)),
          decoder_(layout_, count_step_),
          index_(count_step_, Hertz(header.output_rate_hz)),
          clock_(clock_options(header)),
          clip_counts_(std::ldexp(profile_of(header).rated_range.value(),
                                  profile_of(header).acceleration_fraction_bits)),
          slow_(profile_of(header),
                {clock_, record_header_, header_.record_age, errors_, sink_, counters_}) {
        begin_run();
        adopt(header);
    }

    [[nodiscard]] bool is_continued_by(const journal::Header& next) const {
        return next.session == header_.session && journal::is_same_stream(header_, next);
    }

    void continue_with(const journal::Header& next) {
        if (next.declared_rate_hz != header_.declared_rate_hz) close_records(false);
        adopt(next);
    }

    void receive(const journal::RxChunk& chunk) {
        arrivals_.add(chunk);
        std::span<const std::byte> input(chunk.bytes);
        while (const auto event = decoder_.next(input)) {
            if (const auto* frame = std::get_if<wire::BurstFrame>(&*event))
                take_frame(frame->values());
            else
                take_loss(std::get<wire::Discarded>(*event));
        }
    }

    void observe_clock(const timing::ClockReading& reading) {
        clock_.observe_clock(reading);
        if (retiming_) retiming_->observe_clock(reading);
        if (last_index_ && clock_.awake(reading.raw) - last_arrival_ > header_.record_age &&
            clock_.is_fixed(*last_index_))
            close_channels(false, next_index());
        if (const auto last = last_index_ ? clock_.time_of(*last_index_) : std::nullopt)
            slow_.pass(last->utc + since_last_sample(reading.raw));
        errors_.forget_before(oldest_unpacked());
    }

    void observe_oven(const journal::OvenChunk& poll) {
        if (last_index_) slow_.add(*last_index_, since_last_sample(poll.time), poll);
    }

    void close_records(bool ends_series) {
        close_channels(ends_series, next_index());
        slow_.close(ends_series);
    }

    /// Ends the session: pending bytes will not become a frame any more.
    void end() {
        close_records(true);
        counters_.bytes_skipped += decoder_.pending_bytes();
    }

    [[nodiscard]] std::optional<std::int64_t> last_index() const noexcept { return last_index_; }
    [[nodiscard]] timing::SampleClock& clock() noexcept { return clock_; }

private:
    struct Channel {
        ChannelPacker packer;
        std::optional<Axis> axis;  ///< Absent for the temperature.
    };

    void adopt(const journal::Header& header) {
        header_ = header;
        record_header_.network = header.codes.network;
        record_header_.station = header.codes.station;
        record_header_.location = header.codes.location;
        record_header_.nominal_rate = Hertz(header.output_rate_hz);
        record_header_.declared_rate_hz = header.declared_rate_hz;
        slow_.use_oven_interval(journal::OvenPlace::inner, header.oven_interval);
        slow_.use_oven_interval(journal::OvenPlace::outer, header.outer_oven_interval);
        observe_clock(header.clock);
    }

    void open_channels() {
        const int rate_hz = header_.output_rate_hz;
        channels_.clear();
        for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
            if (!layout_.has_axis(axis)) continue;
            const auto& suffix = header_.codes.axes[static_cast<std::size_t>(axis)];
            channels_.push_back({ChannelPacker(channel_code(rate_hz, "N" + suffix)), axis});
        }
        if (layout_.has_temperature())
            channels_.push_back({ChannelPacker(channel_code(rate_hz, "K1")), std::nullopt});
        slow_.begin_run(channels_.front().packer.code(), layout_.has_temperature());
    }

    [[nodiscard]] RecordContext context() {
        return {clock_, record_header_, header_.record_age, errors_, slow_, counters_};
    }

    /// Returns the time from the instant of the newest sample to `raw`.
    [[nodiscard]] Nanoseconds since_last_sample(RawTime raw) const {
        return clock_options(header_).fixed_delay + (clock_.awake(raw) - last_arrival_);
    }
    [[nodiscard]] std::int64_t next_index() const { return last_index_ ? *last_index_ + 1 : 0; }

    [[nodiscard]] std::int64_t oldest_unpacked() const {
        std::int64_t oldest = next_index();
        for (const auto& channel : channels_)
            if (!channel.packer.is_empty()) oldest = std::min(oldest, channel.packer.first());
        return oldest;
    }

    void take_loss(const wire::Discarded& discarded) {
        stream_offset_ += discarded.byte_count;
        skipped_since_frame_ += discarded.byte_count;
        counters_.bytes_skipped += discarded.byte_count;
        if (discarded.reason == wire::Discarded::Reason::bad_checksum)
            ++counters_.checksum_errors;
        else
            ++counters_.framing_errors;
        errors_.add(next_index());
    }

    void take_frame(const wire::BurstValues& values) {
        stream_offset_ += layout_.frame_size();
        ++counters_.frames;
        const RawTime raw_arrival = arrivals_.of(stream_offset_, header_.baud);
        const RawTime arrival = clock_.awake(raw_arrival);
        timing::Placement placement = place(values, arrival);
        if (placement.kind == Kind::new_session) {
            restart();
            placement = place(values, arrival);
        }
        skipped_since_frame_ = 0;
        if (values.flag & (wire::kFlagError | wire::kFlagAliasing | wire::kFlagAlarms))
            ++counters_.error_flags;
        if (placement.kind == Kind::duplicate) {
            ++counters_.duplicates;
        } else if (placement.kind == Kind::anomaly) {
            ++counters_.anomalies;
        } else {
            clock_.observe(placement.index, raw_arrival);
            if (retiming_) retiming_->observe(placement.index, raw_arrival);
            last_index_ = placement.index;
            last_arrival_ = arrival;
            if (is_data(values)) store({placement.index, values});
        }
    }

    [[nodiscard]] timing::Placement place(const wire::BurstValues& values, RawTime arrival) {
        if (layout_.has_count()) {
            const bool is_contiguous =
                skipped_since_frame_ <= kContiguousFrames * layout_.frame_size() &&
                (!last_index_ || arrival - last_arrival_ < kContiguousSilence);
            return index_.place(values.count, is_contiguous, arrival);
        }
        // Without a counter, only the skipped bytes show a loss.
        const std::uint64_t frame_size = layout_.frame_size();
        const std::uint64_t lost =
            last_index_ ? (skipped_since_frame_ + frame_size / 2) / frame_size : 0;
        return {last_index_ ? Kind::next : Kind::first,
                next_index() + static_cast<std::int64_t>(lost), 0};
    }

    // Begins again after the device restarted in mid-stream.
    void restart() {
        close_records(true);
        index_ = timing::SampleIndex(count_step_, Hertz(header_.output_rate_hz));
        clock_.restart_index();
        last_index_.reset();
        next_stored_.reset();
        errors_ = {};
        begin_run();
    }

    void begin_run() {
        ++counters_.sessions;
        if (retiming_) retiming_->begin_run(header_, clock_options(header_), clock_);
        open_channels();
    }

    void store(const Sample& sample) {
        require_invariant(!next_stored_ || sample.index >= *next_stored_,
                          "no sample is stored twice");
        if (next_stored_ && sample.index != *next_stored_) {
            ++counters_.gaps;
            counters_.samples_missing += static_cast<std::uint64_t>(sample.index - *next_stored_);
            close_channels(false, sample.index);
        } else if (next_stored_ && sample.index == clock_.last_break()) {
            close_channels(false, sample.index);
        }
        next_stored_ = sample.index + 1;
        const RecordContext context = this->context();
        for (auto& channel : channels_) {
            if (channel.axis) {
                const auto axis = static_cast<unsigned>(*channel.axis);
                const std::int32_t counts = sample.values.axes[axis];
                const bool is_clipped = (sample.values.flag & (kFlagAlarmX >> axis)) ||
                                        std::abs(static_cast<double>(counts)) >= clip_counts_;
                channel.packer.add(context, sample.index, counts, is_clipped);
            } else {
                channel.packer.add(context, sample.index, sample.values.temperature, false);
            }
        }
        slow_.add(sample.index, sample.values.temperature);
        sink_.sample(sample);
    }

    void close_channels(bool ends_series, std::int64_t next_first) {
        const RecordContext context = this->context();
        for (auto& channel : channels_) channel.packer.close(context, ends_series);
        errors_.forget_before(next_first);
    }

    journal::Header header_;
    RecordHeader record_header_;
    Sink& sink_;
    Counters& counters_;
    Retiming* retiming_;
    wire::BurstLayout layout_;
    std::uint16_t count_step_;
    wire::BurstDecoder decoder_;
    timing::SampleIndex index_;
    timing::SampleClock clock_;
    double clip_counts_;
    Arrivals arrivals_;
    std::vector<Channel> channels_;
    IndexMarks errors_;
    SlowChannels slow_;
    std::uint64_t stream_offset_ = 0;  ///< Bytes covered by events of the decoder.
    std::uint64_t skipped_since_frame_ = 0;
    std::optional<std::int64_t> last_index_;
    RawTime last_arrival_;
    std::optional<std::int64_t> next_stored_;
};

Archiver::Archiver(Sink& sink, Retiming* retiming)
    : gate_(std::make_unique<TimeGate>(sink, counters_)), retiming_(retiming) {}
Archiver::~Archiver() = default;

void Archiver::take(const journal::Chunk& chunk) {
    if (const auto* header = std::get_if<journal::Header>(&chunk)) {
        if (session_ && session_->is_continued_by(*header)) {
            session_->continue_with(*header);
            return;
        }
        if (session_) session_->end();
        session_.reset();  // Bytes after a refused header belong to no session.
        session_ = std::make_unique<Session>(*header, *gate_, counters_, retiming_);
    } else if (const auto* received = std::get_if<journal::RxChunk>(&chunk)) {
        counters_.bytes += received->bytes.size();
        if (session_)
            session_->receive(*received);
        else
            counters_.bytes_skipped += received->bytes.size();
    } else if (const auto* reading = std::get_if<timing::ClockReading>(&chunk)) {
        if (session_) session_->observe_clock(*reading);
    } else if (const auto* poll = std::get_if<journal::OvenChunk>(&chunk)) {
        if (session_) session_->observe_oven(*poll);
    }
}

void Archiver::close_records() {
    if (session_) session_->close_records(false);
}

bool Archiver::are_times_fixed() const noexcept {
    const auto last = last_index();
    return !last || session_->clock().is_fixed(*last);
}

std::optional<std::int64_t> Archiver::last_index() const noexcept {
    return session_ ? session_->last_index() : std::nullopt;
}

timing::SampleClock* Archiver::clock() noexcept { return session_ ? &session_->clock() : nullptr; }

}  // namespace a351::archive
