/// @file
/// Day files.  A record that is accepted must decode to the same values after it is packed again.
/// For any file content, the reader must return non-empty segments and damage within the file.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using fuzz::require;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    for (std::size_t at = 0; at + kRecordSize <= size; at += kRecordSize) {
        const auto decoded = decode_record(bytes.subspan(at, kRecordSize));
        if (!decoded) continue;
        require(!decoded->samples.empty() && std::isfinite(decoded->rate_hz()));
        const PackedRecord packed = pack_record(decoded->header, decoded->samples);
        const auto again = decode_record(packed.bytes);
        require(again && again->header.start == decoded->header.start &&
                std::equal(again->samples.begin(), again->samples.end(), decoded->samples.begin()));
    }
    const UtcTime day = *parse_rfc3339("2026-03-01T00:00:00Z");
    const StationCodes codes{.network = "XX", .station = "A351", .location = "00"};
    fuzz::file_of(fuzz::text_of(data, size),
                  std::filesystem::relative(sds_file("/", codes, "BNZ", day), "/"));
    const ChannelData read =
        read_channel(fuzz::folder(), codes, "BNZ", day, day + std::chrono::days(1), 50.0);
    if (read.rate_conflict) {
        require(read.rate_conflict->observed_hz > 0.0);
    }
    for (const Segment& segment : read.segments) {
        require(!segment.counts.empty() && !segment.anchors.empty());
    }
    for (const archive::Damage& damage : read.damage) {
        require(damage.offset + damage.byte_count <= size);
    }
    return 0;
}
