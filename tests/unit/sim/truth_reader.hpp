#pragma once

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/text/text_file.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim {

/// Returns all records of a truth file, as sim/truth/truth-format.md describes it.
inline std::vector<truth::Record> read_truth(const std::filesystem::path& file) {
    constexpr std::size_t kHeaderSize = 16, kRecordSize = 40;
    const std::string bytes = text::read_text_file(file);
    REQUIRE(bytes.starts_with("A351TRU2"));
    REQUIRE(bytes.size() % kRecordSize == kHeaderSize);
    std::vector<truth::Record> records((bytes.size() - kHeaderSize) / kRecordSize);
    const char* at = bytes.data() + kHeaderSize;
    const auto take = [&at](auto& field) {
        std::memcpy(&field, at, sizeof field);
        at += sizeof field;
    };
    for (truth::Record& record : records) {
        std::int64_t utc_ns = 0;
        take(utc_ns);
        record.utc = UtcTime(Nanoseconds(utc_ns));
        take(record.values.axes);
        take(record.values.temperature);
        take(record.values.count);
        take(record.sampling_run);
        take(record.grid_index);
        take(record.fate);
        at += 7;  // Reserved.
    }
    return records;
}

}  // namespace a351::sim
