#include "protocol/archive/channel_packer.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/invariant.hpp"

namespace a351::archive {
namespace {

using std::chrono::days;
using std::chrono::floor;
using std::chrono::seconds;

constexpr Nanoseconds kQuestionable = std::chrono::milliseconds(10);
constexpr std::int64_t kMostSeconds = 60;  // Samples of a record of a slow channel.

}  // namespace

bool IndexMarks::any_in(std::int64_t first, std::int64_t last) const {
    const auto found = std::lower_bound(indices_.begin(), indices_.end(), first);
    return found != indices_.end() && *found <= last;
}

void set_timing(RecordHeader& header, const timing::SampleTime& time) {
    header.is_clock_locked = time.is_host_synchronised && time.state == timing::State::locked;
    header.is_time_questionable = !time.is_host_synchronised || time.uncertainty > kQuestionable;
    header.timing_quality_percent = timing_quality_percent(time.uncertainty);
}

ChannelPacker::ChannelPacker(std::string code) : code_(std::move(code)) {
    samples_.reserve(kMostSamplesPerRecord);
}

void ChannelPacker::add(const RecordContext& context, std::int64_t index, std::int32_t counts,
                        bool is_clipped) {
    require_invariant(
        samples_.empty() || index == first_ + static_cast<std::int64_t>(samples_.size()),
        "the samples that wait for a record have no gap");
    if (samples_.empty()) first_ = index;
    samples_.push_back(counts);
    if (is_clipped) clipped_.add(index);
    const double most_samples =
        static_cast<double>(context.record_age.count()) * context.header.nominal_rate.value();
    const auto is_old = [&] {
        return !samples_.empty() && static_cast<double>(index - first_) >= most_samples &&
               context.clock.is_fixed(index);
    };
    // A record that a shutdown ended early is followed by a younger one.
    if (samples_.size() >= kMostSamplesPerRecord) pack_one(context, false);
    while (is_old()) pack_one(context, false);
}

void ChannelPacker::close(const RecordContext& context, bool ends_series) {
    while (!samples_.empty()) pack_one(context, ends_series);
}

// Returns the number of samples before midnight: a record lies within the UTC day of its day file.
// Their times are those that a reader computes from the header.
std::size_t ChannelPacker::samples_before_midnight(const RecordHeader& header) const {
    const UtcTime midnight = floor<days>(header.start) + days(1);
    std::size_t count = samples_.size();
    while (count > 1 &&
           header.start + from_seconds(static_cast<double>(count - 1) / header.rate_hz()) >=
               midnight)
        --count;
    return count;
}

void ChannelPacker::pack_one(const RecordContext& context, bool ends_series) {
    const auto time = *context.clock.time_of(first_);
    RecordHeader header = context.header;
    header.channel = code_;
    header.start = floor<std::chrono::microseconds>(time.utc);
    set_timing(header, time);

    std::size_t available = samples_before_midnight(header);
    if (const auto held = context.sink.samples_in_archive(code_, header.start))
        available = std::min(available, *held);
    const auto samples = std::span<const std::int32_t>(samples_).first(available);
    PackedRecord packed = pack_record(header, samples);

    require_invariant(packed.sample_count > 0 && packed.sample_count <= samples.size(),
                      "a record has at least one of its samples and no others");
    // The size of the record, and therefore these flags, are known only after packing.
    const std::int64_t end = first_ + static_cast<std::int64_t>(packed.sample_count);
    header.starts_series = !has_started_;
    header.ends_series = ends_series && packed.sample_count == samples_.size();
    header.is_clipped = clipped_.any_in(first_, end - 1);
    header.had_transmission_errors = context.errors.any_in(first_, end);
    if (header.starts_series || header.ends_series || header.is_clipped ||
        header.had_transmission_errors)
        packed = pack_record(header, samples);

    if (packed.is_integer_coded) ++context.counters.integer_records;
    context.sink.record(code_, packed, end - 1);
    has_started_ = true;
    samples_.erase(samples_.begin(),
                   samples_.begin() + static_cast<std::ptrdiff_t>(packed.sample_count));
    first_ = end;
    clipped_.forget_before(first_);
}

SecondPacker::SecondPacker(std::string_view code, seconds interval)
    : code_(code),
      interval_(interval),
      most_age_(std::min<seconds>(kMostSeconds * interval, std::chrono::hours(1))) {
    counts_.reserve(static_cast<std::size_t>(most_age_ / interval_) + 1);
}

void SecondPacker::add(const RecordContext& context, const SecondSample& sample) {
    const auto next = first_ + interval_ * static_cast<std::int64_t>(counts_.size());
    const bool is_next_day = floor<days>(sample.second) != floor<days>(first_);
    if (sample.second != next || is_next_day) close(context, false);
    if (counts_.empty()) {
        first_ = sample.second;
        first_index_ = sample.index;
    }
    counts_.push_back(sample.counts);
    last_index_ = sample.index;
    pass(context, sample.second);
}

void SecondPacker::pass(const RecordContext& context, UtcTime now) {
    if (counts_.empty() || now - first_ < most_age_) return;
    // A run that was shut down knew samples earlier than its replay does: they are still to come.
    if (context.sink.samples_in_archive(code_, first_).value_or(0) > counts_.size()) return;
    close(context, false);
}

void SecondPacker::close(const RecordContext& context, bool ends_series) {
    while (!counts_.empty()) pack_one(context, ends_series);
}

void SecondPacker::pack_one(const RecordContext& context, bool ends_series) {
    RecordHeader header = context.header;
    header.channel = code_;
    header.nominal_rate = Hertz(1.0 / static_cast<double>(interval_.count()));
    header.declared_rate_hz.reset();
    header.start = first_;
    set_timing(header, *context.clock.time_of(first_index_));
    std::size_t available = counts_.size();
    if (const auto held = context.sink.samples_in_archive(code_, header.start))
        available = std::min(available, *held);
    header.starts_series = !has_started_;
    header.ends_series = ends_series && available == counts_.size();
    const PackedRecord packed = pack_record(header, std::span(counts_).first(available));

    if (packed.is_integer_coded) ++context.counters.integer_records;
    context.sink.record(code_, packed, last_index_);
    has_started_ = true;
    counts_.erase(counts_.begin(),
                  counts_.begin() + static_cast<std::ptrdiff_t>(packed.sample_count));
    first_ += interval_ * static_cast<std::int64_t>(packed.sample_count);
}

}  // namespace a351::archive
