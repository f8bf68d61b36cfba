/// @file
/// Bytes from a sensor, in any layout and cut anywhere.  Each byte must belong to exactly one
/// event, and the events must not depend on the cuts.

#include <algorithm>
#include <span>
#include <vector>

#include "protocol/wire/burst_decoder.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using fuzz::require;

struct Seen {
    bool is_frame = false;
    std::size_t byte_count = 0;
    bool operator==(const Seen&) const = default;
};

std::vector<Seen> events(const wire::BurstLayout& layout, std::uint16_t step,
                         std::span<const std::byte> stream, std::size_t cut) {
    wire::BurstDecoder decoder(layout, step);
    std::vector<Seen> seen;
    std::size_t covered = 0;
    for (std::size_t begin = 0; begin < stream.size(); begin += cut) {
        auto part = stream.subspan(begin, std::min(cut, stream.size() - begin));
        while (const auto event = decoder.next(part)) {
            const auto* const lost = std::get_if<wire::Discarded>(&*event);
            seen.push_back({lost == nullptr, lost ? lost->byte_count : layout.frame_size()});
            require(seen.back().byte_count >= 1 && seen.back().byte_count <= layout.frame_size());
            covered += seen.back().byte_count;
        }
        require(part.empty());
    }
    require(covered + decoder.pending_bytes() == stream.size());
    return seen;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4) return 0;
    const auto layout = wire::BurstLayout::from_burst_ctrl(
        static_cast<std::uint16_t>((data[0] << 8 | data[1]) & 0xC703));
    if (!layout) return 0;
    const std::uint16_t step = data[2] % 2 == 0 ? 80 : data[2];
    const auto stream = std::as_bytes(std::span(data + 4, size - 4));
    const auto whole = events(*layout, step, stream, std::max<std::size_t>(stream.size(), 1));
    require(whole == events(*layout, step, stream, data[3] % 40 + 1U));
    return 0;
}
