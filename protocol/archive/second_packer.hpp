#pragma once
/// @file
/// Samples of one slow channel that are not in a record yet; decides where its records end.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/archive/channel_packer.hpp"

namespace a351::record {

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
