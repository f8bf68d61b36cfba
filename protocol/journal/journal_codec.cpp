#include "protocol/journal/journal_codec.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "protocol/core/invariant.hpp"

namespace a351::journal {

namespace {

using timing::ClockReading;

// CRC-32C: G. Castagnoli et al., IEEE Trans. Commun. 41(6), 883-892, 1993; reflected and inverted
// as in RFC 3720, appendix B.4.  journal_codec_test.cpp checks the values given there.
using Crc32c = boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true>;

template <class Int>
void put(std::vector<std::byte>& out, std::type_identity_t<Int> value) {
    using Bits = std::make_unsigned_t<Int>;
    const auto bits = static_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(Int); ++i)
        out.push_back(static_cast<std::byte>(bits >> (8 * i) & 0xFFU));
}

void put(std::vector<std::byte>& out, std::string_view text) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    out.insert(out.end(), bytes, bytes + text.size());
}

/// Takes fields from the front of a payload.  After one that is missing or out of range, all
/// further ones are missing too.
class Fields {
public:
    explicit Fields(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class Int>
    Int take() {
        using Bits = std::make_unsigned_t<Int>;
        Bits bits = 0;
        const auto field = take_bytes(sizeof(Int));
        for (std::size_t i = 0; i < field.size(); ++i) {
            bits = static_cast<Bits>(
                bits | static_cast<Bits>(Bits(std::to_integer<std::uint8_t>(field[i])) << (8 * i)));
        }
        return static_cast<Int>(bits);
    }

    std::span<const std::byte> take_bytes(std::size_t count) {
        if (count > bytes_.size()) {
            is_short_ = true;
            bytes_ = {};
            return {};
        }
        const auto front = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return front;
    }

    std::int64_t take_within(std::int64_t low, std::int64_t high) {
        const auto value = take<std::int64_t>();
        if (low <= value && value <= high) return value;
        is_short_ = true;
        bytes_ = {};
        return 0;
    }

    Nanoseconds take_instant() {
        return Nanoseconds(take_within(kEarliestInstant.count(), kLatestInstant.count()));
    }
    RawTime take_raw_time() { return RawTime(take_instant()); }
    UtcTime take_utc() { return UtcTime(take_instant()); }
    Nanoseconds take_span() {
        return Nanoseconds(take_within(-kLongestSpan.count(), kLongestSpan.count()));
    }
    std::int64_t take_index() { return take_within(-kLargestIndex, kLargestIndex); }
    std::int64_t take_clock_error() { return take_within(-kMostClockError_us, kMostClockError_us); }

    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size(); }
    [[nodiscard]] bool is_short() const noexcept { return is_short_; }
    [[nodiscard]] bool is_used_up() const noexcept { return !is_short_ && bytes_.empty(); }

private:
    std::span<const std::byte> bytes_;
    bool is_short_ = false;
};

std::string to_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool do_reads_fit(const RxChunk& rx) {
    std::uint32_t end = 0;
    for (const ReadStamp& read : rx.reads) {
        if (read.end <= end) return false;
        end = read.end;
    }
    return end > 0 && end == rx.bytes.size();
}

bool has_registers_by_outcome(const OvenChunk& poll) {
    return poll.registers.empty() == (poll.outcome != OvenOutcome::answered);
}

struct PayloadWriter {
    std::vector<std::byte>& out;

    void operator()(const Header& header) const { put(out, header_to_json(header)); }
    void operator()(const RxChunk& rx) const {
        if (!do_reads_fit(rx))
            throw std::invalid_argument("RxChunk: reads must ascend and end at the last byte");
        const RawTime first = rx.reads.front().time;
        put<std::int64_t>(out, first.time_since_epoch().count());
        put<std::uint32_t>(out, static_cast<std::uint32_t>(rx.reads.size()));
        for (const ReadStamp& read : rx.reads) {
            put<std::uint32_t>(out, read.end);
            put<std::int64_t>(out, (read.time - first).count());
        }
        out.insert(out.end(), rx.bytes.begin(), rx.bytes.end());
    }
    void operator()(const TxChunk& tx) const {
        put<std::int64_t>(out, tx.time.time_since_epoch().count());
        out.insert(out.end(), tx.bytes.begin(), tx.bytes.end());
    }
    void operator()(const ClockReading& clock) const {
        put<std::int64_t>(out, clock.raw.time_since_epoch().count());
        put<std::int64_t>(out, clock.boottime.count());
        put<std::int64_t>(out, clock.realtime.time_since_epoch().count());
        const auto leap = static_cast<unsigned>(clock.leap);
        put<std::uint8_t>(
            out, static_cast<std::uint8_t>((clock.is_synchronised ? 1U : 0U) | leap << 1U));
        put<std::int64_t>(out, clock.max_error_us);
        put<std::int64_t>(out, clock.estimated_error_us);
    }
    void operator()(const ModelChunk& model) const {
        put<std::int64_t>(out, model.index);
        put<std::int64_t>(out, model.time.utc.time_since_epoch().count());
        // While the host's clock is in 1970 the uncertainty is decades.  A reader takes a span
        // above kLongestSpan for damage.
        put<std::int64_t>(out, std::min(model.time.uncertainty, kLongestSpan).count());
        put<std::uint8_t>(out, static_cast<std::uint8_t>(model.time.state));
    }
    void operator()(const EventChunk& event) const { put(out, event.json); }
    void operator()(const MarkChunk& mark) const {
        for (const std::uint8_t byte : mark.session.bytes) put<std::uint8_t>(out, byte);
        for (const ChannelMark& channel : mark.channels) {
            if (channel.channel.size() > 255)
                throw std::invalid_argument("ChannelMark: channel longer than 255 characters");
            put<std::uint8_t>(out, static_cast<std::uint8_t>(channel.channel.size()));
            put(out, channel.channel);
            put<std::int64_t>(out, channel.index);
            put<std::int64_t>(out, channel.utc.time_since_epoch().count());
        }
    }
    void operator()(const OvenChunk& poll) const {
        if (!has_registers_by_outcome(poll) || poll.registers.size() > 255)
            throw std::invalid_argument("OvenChunk: 1-255 registers if answered, else none");
        put<std::int64_t>(out, poll.time.time_since_epoch().count());
        put<std::uint8_t>(out, static_cast<std::uint8_t>(poll.outcome));
        put<std::uint8_t>(out, poll.decimals);
        put<std::uint8_t>(out, static_cast<std::uint8_t>(poll.registers.size()));
        for (const std::uint16_t word : poll.registers) put<std::uint16_t>(out, word);
    }
};

std::optional<Chunk> decode_rx(Fields fields) {
    RxChunk rx;
    const auto first = fields.take_raw_time();
    const auto read_count = fields.take<std::uint32_t>();
    // The count is checked against the payload before anything is allocated for it.
    if (fields.is_short() || read_count > fields.left() / 12) return std::nullopt;
    rx.reads.reserve(read_count);
    for (std::uint32_t i = 0; i < read_count; ++i) {
        const auto end = fields.take<std::uint32_t>();
        rx.reads.push_back({end, first + fields.take_span()});
    }
    if (fields.is_short()) return std::nullopt;
    const auto bytes = fields.take_bytes(fields.left());
    rx.bytes.assign(bytes.begin(), bytes.end());
    if (!do_reads_fit(rx)) return std::nullopt;
    return rx;
}

std::optional<Chunk> decode_tx(Fields fields) {
    TxChunk tx;
    tx.time = fields.take_raw_time();
    if (fields.is_short()) return std::nullopt;
    const auto bytes = fields.take_bytes(fields.left());
    tx.bytes.assign(bytes.begin(), bytes.end());
    return tx;
}

std::optional<Chunk> decode_clock(Fields fields) {
    ClockReading clock;
    clock.raw = fields.take_raw_time();
    clock.boottime = fields.take_instant();
    clock.realtime = fields.take_utc();
    const auto state = fields.take<std::uint8_t>();
    clock.is_synchronised = (state & 1U) != 0;
    clock.leap = static_cast<timing::LeapSecond>(state >> 1U);
    clock.max_error_us = fields.take_clock_error();
    clock.estimated_error_us = fields.take_clock_error();
    if (!fields.is_used_up() || clock.leap > timing::LeapSecond::removed) return std::nullopt;
    return clock;
}

std::optional<Chunk> decode_model(Fields fields) {
    ModelChunk model;
    model.index = fields.take_index();
    model.time.utc = fields.take_utc();
    model.time.uncertainty = fields.take_span();
    const auto state = fields.take<std::uint8_t>();
    if (!fields.is_used_up()) return std::nullopt;
    if (state > static_cast<std::uint8_t>(timing::State::holdover)) return std::nullopt;
    model.time.state = static_cast<timing::State>(state);
    return model;
}

std::optional<Chunk> decode_mark(Fields fields) {
    MarkChunk mark;
    for (std::uint8_t& byte : mark.session.bytes) byte = fields.take<std::uint8_t>();
    while (fields.left() > 0) {
        ChannelMark channel;
        channel.channel = to_text(fields.take_bytes(fields.take<std::uint8_t>()));
        channel.index = fields.take_index();
        channel.utc = fields.take_utc();
        mark.channels.push_back(std::move(channel));
    }
    if (!fields.is_used_up()) return std::nullopt;
    return mark;
}

std::optional<Chunk> decode_oven(Fields fields, OvenPlace place) {
    OvenChunk poll;
    poll.place = place;
    poll.time = fields.take_raw_time();
    const auto outcome = fields.take<std::uint8_t>();
    poll.outcome = static_cast<OvenOutcome>(outcome);
    poll.decimals = fields.take<std::uint8_t>();
    poll.registers.resize(fields.take<std::uint8_t>());
    for (std::uint16_t& word : poll.registers) word = fields.take<std::uint16_t>();
    if (!fields.is_used_up() || !has_registers_by_outcome(poll)) return std::nullopt;
    if (outcome >= kOvenOutcomeCount) return std::nullopt;
    return poll;
}

ChunkType type_of(const Chunk& chunk) {
    const auto* const poll = std::get_if<OvenChunk>(&chunk);
    if (poll != nullptr && poll->place == OvenPlace::outer) return ChunkType::outer_oven;
    return static_cast<ChunkType>(chunk.index() + 1);
}

template <class Int>
void put_at(std::span<std::byte> out, std::type_identity_t<Int> value) {
    for (std::size_t i = 0; i < sizeof(Int); ++i)
        out[i] = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
}

constexpr std::size_t kSequenceAt = 5, kCrcAt = 9;  // Places in the header of a chunk, bytes.

std::array<std::byte, kCrcAt> encode_fields_before_crc(const ChunkHeader& header) {
    std::array<std::byte, kCrcAt> out{};
    put_at<std::uint32_t>(out, header.length);
    out[kSequenceAt - 1] = static_cast<std::byte>(header.type);
    put_at<std::uint32_t>(std::span(out).subspan(kSequenceAt), header.sequence);
    return out;
}

}  // namespace

std::vector<std::byte> encode_preamble() {
    std::vector<std::byte> out;
    out.reserve(kPreambleSize);
    put(out, kMagic);
    put<std::uint32_t>(out, kVersion);
    return out;
}

bool is_preamble(std::span<const std::byte> bytes) noexcept {
    if (bytes.size() != kPreambleSize) return false;
    Fields version(bytes.subspan(kMagic.size()));
    return std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0 &&
           version.take<std::uint32_t>() == kVersion;
}

std::vector<std::byte> encode_chunk(const Chunk& chunk, std::uint32_t sequence) {
    std::vector<std::byte> out;
    append_chunk(out, chunk, sequence);
    return out;
}

void append_chunk(std::vector<std::byte>& out, const Chunk& chunk, std::uint32_t sequence) {
    const std::size_t before = out.size();
    try {
        out.resize(before + kChunkHeaderSize);
        std::visit(PayloadWriter{out}, chunk);
        const std::size_t size = out.size() - before - kChunkHeaderSize;
        if (size > kMostPayloadBytes) {
            throw std::invalid_argument(fmt::format(
                "journal chunk: payload of {} bytes; at most {}", size, kMostPayloadBytes));
        }
        const auto encoded = std::span(out).subspan(before);
        put_at<std::uint32_t>(encoded, static_cast<std::uint32_t>(size));
        encoded[kSequenceAt - 1] = static_cast<std::byte>(type_of(chunk));
        renumber_chunk(encoded, sequence);
    } catch (...) {
        out.resize(before);
        throw;
    }
}

void renumber_chunk(std::span<std::byte> chunk, std::uint32_t sequence) {
    put_at<std::uint32_t>(chunk.subspan(kSequenceAt), sequence);
    const ChunkHeader header = decode_chunk_header(chunk);
    require_invariant(chunk.size() == kChunkHeaderSize + header.length,
                      "an encoded chunk has the length in its header");
    put_at<std::uint32_t>(chunk.subspan(kCrcAt),
                          chunk_crc(header, chunk.subspan(kChunkHeaderSize)));
}

ChunkHeader decode_chunk_header(std::span<const std::byte> bytes) noexcept {
    Fields fields(bytes);
    ChunkHeader header;
    header.length = fields.take<std::uint32_t>();
    header.type = fields.take<std::uint8_t>();
    header.sequence = fields.take<std::uint32_t>();
    header.crc = fields.take<std::uint32_t>();
    return header;
}

std::uint32_t chunk_crc(const ChunkHeader& header, std::span<const std::byte> payload) {
    const auto front = encode_fields_before_crc(header);
    Crc32c crc;
    crc.process_bytes(front.data(), front.size());
    crc.process_bytes(payload.data(), payload.size());
    return crc.checksum();
}

bool is_known(std::uint8_t type) noexcept {
    return type >= static_cast<std::uint8_t>(ChunkType::head) &&
           type <= static_cast<std::uint8_t>(ChunkType::outer_oven);
}

std::optional<Chunk> decode_payload(ChunkType type, std::span<const std::byte> payload) {
    switch (type) {
        case ChunkType::head: {
            auto header = parse_header(to_text(payload));
            if (!header) return std::nullopt;
            return Chunk(std::move(*header));
        }
        case ChunkType::rx:
            return decode_rx(Fields(payload));
        case ChunkType::tx:
            return decode_tx(Fields(payload));
        case ChunkType::clock:
            return decode_clock(Fields(payload));
        case ChunkType::model:
            return decode_model(Fields(payload));
        case ChunkType::event:
            return EventChunk{to_text(payload)};
        case ChunkType::mark:
            return decode_mark(Fields(payload));
        case ChunkType::oven:
            return decode_oven(Fields(payload), OvenPlace::inner);
        case ChunkType::outer_oven:
            return decode_oven(Fields(payload), OvenPlace::outer);
    }
    return std::nullopt;
}

}  // namespace a351::journal
