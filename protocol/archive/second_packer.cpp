#include "protocol/archive/second_packer.hpp"

#include <algorithm>
#include <span>

namespace a351::record {

using std::chrono::days;
using std::chrono::floor;
using std::chrono::seconds;

SecondPacker::SecondPacker(std::string_view code, seconds interval)
    : code_(code),
      interval_(interval),
      most_age_(std::min<seconds>(kMostRecordAge.count() * interval, std::chrono::hours(1))) {
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

}  // namespace a351::record
