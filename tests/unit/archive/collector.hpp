#pragma once
/// @file
/// Collector of an archiver's records and samples in memory.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "tests/unit/journal/journal_stream.hpp"

namespace a351::archive {

struct Collector : Sink {
    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override {
        packed.emplace_back(channel, record.bytes);
        decoded[channel].push_back(*decode_record(record.bytes));
        last[channel] = last_index;
    }
    void sample(const Sample& sample) override { samples.push_back(sample); }

    [[nodiscard]] std::vector<std::int32_t> counts(const std::string& channel) const {
        std::vector<std::int32_t> all;
        const auto found = decoded.find(channel);
        if (found == decoded.end()) return all;
        for (const auto& record : found->second)
            all.insert(all.end(), record.samples.begin(), record.samples.end());
        return all;
    }

    std::vector<std::pair<std::string, std::array<std::byte, kRecordSize>>> packed;
    std::map<std::string, std::vector<DecodedRecord>> decoded;
    std::map<std::string, std::int64_t> last;
    std::vector<Sample> samples;
};

/// Returns samples first ... end - 1 of an axis of the test stream.
inline std::vector<std::int32_t> expected(unsigned axis, std::int64_t first, std::int64_t end) {
    std::vector<std::int32_t> counts;
    for (std::int64_t k = first; k < end; ++k) counts.push_back(journal::values_of(k).axes[axis]);
    return counts;
}

/// Returns the same chunks with another age at which records end.
inline std::vector<journal::Chunk> with_record_age(std::vector<journal::Chunk> chunks,
                                                   std::chrono::seconds age) {
    for (auto& chunk : chunks)
        if (auto* const header = std::get_if<journal::Header>(&chunk)) header->record_age = age;
    return chunks;
}

inline std::vector<journal::Chunk> joined(std::vector<journal::Chunk> chunks,
                                          const std::vector<journal::Chunk>& more) {
    chunks.insert(chunks.end(), more.begin(), more.end());
    return chunks;
}

struct Run {
    Collector sink;
    Counters counters;
};

inline Run archived(const std::vector<journal::Chunk>& chunks) {
    Run run;
    Archiver archiver(run.sink);
    for (const auto& chunk : chunks) archiver.take(chunk);
    archiver.close_records();
    run.counters = archiver.counters();
    return run;
}

}  // namespace a351::archive
