#include "protocol/journal/stream_end.hpp"

#include "protocol/journal/journal_reader.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::journal {
namespace {

std::optional<StreamEnd> end_within(const std::filesystem::path& segment) {
    const auto header = segment_header(segment);
    const auto* const profile = header ? wire::find_profile(header->profile) : nullptr;
    const auto layout =
        header ? wire::BurstLayout::from_burst_ctrl(header->burst_ctrl) : std::nullopt;
    if (!profile || !profile->has_output_rate(header->output_rate_hz) || !layout ||
        !layout->has_count())
        return std::nullopt;

    std::optional<StreamEnd> end;
    wire::BurstDecoder decoder(*layout, profile->count_step(header->output_rate_hz));
    Reader reader(segment);
    while (const auto chunk = reader.next()) {
        const auto* const received = std::get_if<RxChunk>(&*chunk);
        if (received == nullptr) continue;
        std::span<const std::byte> input(received->bytes);
        while (const auto event = decoder.next(input)) {
            const auto* const frame = std::get_if<wire::BurstFrame>(&*event);
            if (frame == nullptr) continue;
            end = {*header, frame->values().count, received->reads.back().time};
        }
    }
    return end;
}

}  // namespace

std::optional<StreamEnd> stream_end(const std::vector<std::filesystem::path>& segments) {
    std::optional<SessionId> session;
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
        const auto header = segment_header(*segment);
        if (!header) continue;
        if (session && header->session != *session) return std::nullopt;
        session = header->session;
        if (auto end = end_within(*segment)) return end;
    }
    return std::nullopt;
}

}  // namespace a351::journal
