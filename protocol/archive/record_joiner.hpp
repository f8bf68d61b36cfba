#pragma once

#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/miniseed.hpp"

namespace a351::archive {

/// Joins records to segments.
class RecordJoiner {
public:
    /// @param data      receives the samples; must outlive this.
    /// @param from, to  samples outside [from, to) are left out.
    /// @param rate_hz   rate of the samples; absent: that of each record.
    RecordJoiner(ChannelData& data, UtcTime from, UtcTime to, std::optional<double> rate_hz = {})
        : data_(data), from_(from), to_(to), rate_hz_(rate_hz) {}

    /// Adds a record; one that begins within half a sample of the end of the last one continues it.
    void take(const DecodedRecord& record);

private:
    ChannelData& data_;
    UtcTime from_, to_;
    std::optional<double> rate_hz_;
};

}  // namespace a351::archive
