#pragma once

#include <cstddef>
#include <utility>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/miniseed.hpp"

namespace a351::archive {

/// Returns true if a record is of these codes, whatever its channel.
[[nodiscard]] bool is_of(const journal::StationCodes& codes, const RecordHeader& header);

/// Joins records to segments.
class RecordJoiner {
public:
    /// @param data      receives the samples; must outlive this.
    /// @param from, to  samples outside [from, to) are left out.
    /// @param wrong     records with its header_hz have its used_hz instead.
    /// @param memory    of the first segment; what is in it is lost.
    RecordJoiner(ChannelData& data, UtcTime from, UtcTime to,
                 std::optional<RateConflict> wrong = {}, std::vector<std::int32_t> memory = {})
        : data_(data), from_(from), to_(to), wrong_(std::move(wrong)), memory_(std::move(memory)) {
        memory_.clear();
    }

    /// Reserves space for the samples of so many records, when the next one is added.  A segment of
    /// a day that grows without this is copied again and again.
    void expect(std::size_t records) { expected_ = records; }

    /// Adds a record; one that begins within half a sample of the end of the last one continues it.
    void take(const DecodedRecord& record);

private:
    ChannelData& data_;
    UtcTime from_, to_;
    std::optional<RateConflict> wrong_;
    std::vector<std::int32_t> memory_;
    std::size_t expected_ = 0;  ///< Records for which no space is reserved yet.
};

}  // namespace a351::archive
