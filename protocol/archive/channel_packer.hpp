#pragma once
/// @file
/// Samples of one channel that are not in a record yet: they decide where records end.

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"

namespace a351::record {

/// List of sample indices at which something was noted; added in rising order.
class IndexMarks {
public:
    void add(std::int64_t index) {
        if (indices_.empty() || indices_.back() != index) indices_.push_back(index);
    }
    [[nodiscard]] bool any_in(std::int64_t first, std::int64_t last) const;
    void forget_before(std::int64_t index) {
        while (!indices_.empty() && indices_.front() < index) indices_.pop_front();
    }

private:
    std::deque<std::int64_t> indices_;
};

/// Age of the oldest sample at which a record is closed, so that slow channels become visible.
inline constexpr std::chrono::seconds kMostRecordAge{60};

/// Data shared by the records of all channels of a session.
struct RecordContext {
    const timing::SampleClock& clock;
    const RecordHeader& header;  ///< Codes and rates.
    const IndexMarks& errors;    ///< Samples that were due when bytes were discarded.
    ArchiveSink& sink;
    ArchiverCounters& counters;
};

/// Sets the fields of a record about its time: clock locked, time questionable, timing quality.
void set_timing(RecordHeader& header, const timing::SampleTime& time);

/// Packs the samples of one channel into records.
class ChannelPacker {
public:
    explicit ChannelPacker(std::string code);

    /// Adds a sample.  Precondition: the channel is empty or `index` is the next one.
    void add(const RecordContext& context, std::int64_t index, std::int32_t counts,
             bool is_clipped);

    /// Packs all remaining samples.
    void close(const RecordContext& context, bool ends_series);

    [[nodiscard]] const std::string& code() const noexcept { return code_; }
    [[nodiscard]] bool is_empty() const noexcept { return samples_.empty(); }
    [[nodiscard]] std::int64_t first() const noexcept { return first_; }

private:
    void pack_one(const RecordContext& context, bool ends_series);
    [[nodiscard]] std::size_t samples_before_midnight(const timing::SampleClock& clock,
                                                      UtcTime start) const;

    std::string code_;
    std::vector<std::int32_t> samples_;
    std::int64_t first_ = 0;  ///< Index of samples_.front().
    IndexMarks clipped_;
    bool has_started_ = false;
};

/// Sample of a derived channel, at a whole UTC second.
struct SecondSample {
    std::chrono::sys_seconds second;
    std::int32_t counts = 0;
    std::int64_t index = 0;  ///< Sample of the sensor with which it became known.
};

/// Packs the samples of one slow channel.  A record ends before a missing sample or a backward
/// step, at UTC midnight, and when its first sample is old: 60 s, or 60 samples but at most an
/// hour.  The nominal rate is the true one, so there is no blockette 100.
class SecondPacker {
public:
    explicit SecondPacker(std::string_view code,
                          std::chrono::seconds interval = std::chrono::seconds(1));

    void add(const RecordContext& context, const SecondSample& sample);

    /// Closes the record if it is old at `now`, and not shorter than the one in the archive.
    void pass(const RecordContext& context, UtcTime now);

    /// Packs all remaining samples.
    void close(const RecordContext& context, bool ends_series);

private:
    void pack_one(const RecordContext& context, bool ends_series);

    std::string code_;
    std::chrono::seconds interval_, most_age_;
    std::vector<std::int32_t> counts_;
    std::chrono::sys_seconds first_;
    std::int64_t first_index_ = 0, last_index_ = 0;
    bool has_started_ = false;
};

}  // namespace a351::record
