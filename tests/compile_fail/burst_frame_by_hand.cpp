// Law: only the decoder, which verifies the bytes, can make a BurstFrame.
#include "protocol/wire/burst_decoder.hpp"

std::uint16_t count_of(const a351::wire::BurstFrame& frame) { return frame.values().count; }

std::uint16_t made_up() {
#ifdef A351_LEGAL
    a351::wire::BurstDecoder decoder(a351::wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input;
    return count_of(std::get<a351::wire::BurstFrame>(*decoder.next(input)));
#else
    return count_of(a351::wire::BurstFrame(a351::wire::BurstValues{}));
#endif
}
