#pragma once
/// @file
/// The samples of one slow channel that are not in a record yet, and where its records end.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "protocol/archive/channel_packer.hpp"

namespace a351::record {

/// A sample of a derived channel stands on a whole UTC second.
struct SecondSample {
    std::chrono::sys_seconds second;
    std::int32_t counts = 0;
    std::int64_t index = 0;  ///< Of the sensor's sample it was known with.
};

/// A record ends before a sample that is missing or goes back, at UTC midnight and when its first
/// sample is old: 60 s, or 60 samples but not more than an hour.  The nominal rate is the true one:
/// no blockette 100.
class SecondPacker {
public:
    explicit SecondPacker(std::string_view code,
                          std::chrono::seconds interval = std::chrono::seconds(1));

    void add(const RecordContext& context, const SecondSample& sample);

    /// Closes the record if it is old by now, and not shorter than the one the archive holds.
    void pass(const RecordContext& context, UtcTime now);

    /// Packs all that is left.
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
