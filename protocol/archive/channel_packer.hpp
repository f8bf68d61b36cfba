#pragma once
/// @file
/// Samples of one channel that are not in a record yet: they decide where records end.
///
/// Archiver and SlowChannels use it; other code uses Archiver.  A packer gets its context with each
/// call, so that several channels share it.
///
///     ChannelPacker packer("BNZ");
///     packer.add(context, index, counts, is_clipped);   // for each sample
///     packer.close(context, false);                     // before a missing sample

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"

namespace a351::archive {

/// List of sample indices at which something was noted; added in rising order.
class IndexMarks {
public:
    /// Adds an index, not below those before; not checked.  A repeated one is kept once.
    void add(std::int64_t index) {
        if (indices_.empty() || indices_.back() != index) indices_.push_back(index);
    }
    /// Returns true if an index lies within [first, last], both included.  O(log n).
    [[nodiscard]] bool any_in(std::int64_t first, std::int64_t last) const;
    /// Forgets the indices below `index`, so that memory does not grow with the stream.
    void forget_before(std::int64_t index) {
        while (!indices_.empty() && indices_.front() < index) indices_.pop_front();
    }

private:
    std::deque<std::int64_t> indices_;
};

/// Data shared by the records of all channels of a session.  The objects belong to the caller and
/// must outlive the context.
struct RecordContext {
    const timing::SampleClock& clock;  ///< Clock that knows the times of the samples added.
    const RecordHeader& header;        ///< Codes and rates.
    const std::chrono::seconds& record_age;  ///< journal::Header::record_age.
    const IndexMarks& errors;          ///< Samples that were due when bytes were discarded.
    Sink& sink;                        ///< Receiver of the records.
    Counters& counters;                ///< Counters of which a packer raises integer_records.
};

/// Sets the fields of a record about its time: clock locked, time questionable, timing quality.
///
/// The clock is locked if the host is synchronised and the state is `locked`.  The time is
/// questionable if the host is not synchronised or the uncertainty exceeds 10 ms.  All other fields
/// are unchanged.
/// @param time  time of the first sample of the record.
void set_timing(RecordHeader& header, const timing::SampleTime& time);

/// Packs the samples of one channel into records.
///
/// A record never reaches over UTC midnight.  If the archive has a record that begins at the same
/// time, it ends where that one ends.  Start times are rounded down to 1 us.  The destructor drops
/// samples not packed.
class ChannelPacker {
public:
    /// Begins a series without samples: its first record gets the flag of a start.
    /// @param code  channel code, e.g. BNZ.
    explicit ChannelPacker(std::string code);

    /// Adds a sample.  Precondition: the channel is empty or `index` is the next one.
    ///
    /// A record is packed when 721 samples wait, and when the first of them has the age of the
    /// context and the times are fixed: those of a run's first 2 s are not.
    /// @param context     its clock must know the time of the sample.
    /// @param counts      raw value; any 32-bit integer.
    /// @param is_clipped  sets the flag of the record that has the sample.
    void add(const RecordContext& context, std::int64_t index, std::int32_t counts,
             bool is_clipped);

    /// Packs all remaining samples.  Without samples it does nothing.
    /// @param ends_series  marks the last record as the last one of the run.
    void close(const RecordContext& context, bool ends_series);

    /// Returns the channel code given at construction.
    [[nodiscard]] const std::string& code() const noexcept { return code_; }
    /// Returns true if no sample waits to be packed.
    [[nodiscard]] bool is_empty() const noexcept { return samples_.empty(); }
    /// Returns the index of the oldest sample that waits; meaningless if is_empty().
    [[nodiscard]] std::int64_t first() const noexcept { return first_; }

private:
    void pack_one(const RecordContext& context, bool ends_series);
    [[nodiscard]] std::size_t samples_before_midnight(const RecordHeader& header) const;

    std::string code_;
    std::vector<std::int32_t> samples_;
    std::int64_t first_ = 0;  ///< Index of samples_.front().
    IndexMarks clipped_;
    bool has_started_ = false;
};

/// Sample of a derived channel, at a whole UTC second.
struct SecondSample {
    std::chrono::sys_seconds second;  ///< Time of the sample.
    std::int32_t counts = 0;          ///< Value in the unit of the channel, see channel_code.hpp.
    std::int64_t index = 0;           ///< Sample of the sensor with which it became known.
};

/// Packs the samples of one slow channel.  A record ends before a missing sample or a backward
/// step, at UTC midnight, and when its first sample is old: 60 s, or 60 samples but at most an
/// hour.  The nominal rate is the true one, so there is no blockette 100.
class SecondPacker {
public:
    /// Begins a series without samples.
    /// @param code      code of a derived channel.
    /// @param interval  time from sample to sample, >= 1 s; not checked.
    explicit SecondPacker(std::string_view code,
                          std::chrono::seconds interval = std::chrono::seconds(1));

    /// Adds a sample.  If it is not `interval` later than the one before, the record is closed
    /// first.
    /// @param context  its clock must know the time of the sensor's sample.
    void add(const RecordContext& context, const SecondSample& sample);

    /// Closes the record if it is old at `now`, and not shorter than the one in the archive.
    void pass(const RecordContext& context, UtcTime now);

    /// Packs all remaining samples.
    /// @param ends_series  marks the last record as the last one of the run.
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

}  // namespace a351::archive
