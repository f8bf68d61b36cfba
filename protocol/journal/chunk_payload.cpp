#include "protocol/journal/chunk_payload.hpp"

#include <algorithm>
#include <stdexcept>

#include "protocol/journal/journal_header_json.hpp"
#include "protocol/journal/little_endian.hpp"

namespace a351::journal {

namespace {

using timing::ClockReading;

std::int64_t take_within(Fields& fields, std::int64_t low, std::int64_t high) {
    const auto value = fields.take<std::int64_t>();
    if (low <= value && value <= high) return value;
    fields.refuse();
    return 0;
}

Nanoseconds take_instant(Fields& fields) {
    return Nanoseconds(take_within(fields, kEarliestInstant.count(), kLatestInstant.count()));
}
RawTime take_raw_time(Fields& fields) { return RawTime(take_instant(fields)); }
UtcTime take_utc(Fields& fields) { return UtcTime(take_instant(fields)); }
Nanoseconds take_span(Fields& fields) {
    return Nanoseconds(take_within(fields, -kLongestSpan.count(), kLongestSpan.count()));
}
std::int64_t take_index(Fields& fields) {
    return take_within(fields, -kLargestIndex, kLargestIndex);
}
std::int64_t take_clock_error(Fields& fields) {
    return take_within(fields, -kMostClockError_us, kMostClockError_us);
}

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
    const auto first = take_raw_time(fields);
    const auto read_count = fields.take<std::uint32_t>();
    // The count is checked against the payload before anything is allocated for it.
    if (fields.is_short() || read_count > fields.left() / 12) return std::nullopt;
    rx.reads.reserve(read_count);
    for (std::uint32_t i = 0; i < read_count; ++i) {
        const auto end = fields.take<std::uint32_t>();
        rx.reads.push_back({end, first + take_span(fields)});
    }
    if (fields.is_short()) return std::nullopt;
    const auto bytes = fields.take_bytes(fields.left());
    rx.bytes.assign(bytes.begin(), bytes.end());
    if (!do_reads_fit(rx)) return std::nullopt;
    return rx;
}

std::optional<Chunk> decode_tx(Fields fields) {
    TxChunk tx;
    tx.time = take_raw_time(fields);
    if (fields.is_short()) return std::nullopt;
    const auto bytes = fields.take_bytes(fields.left());
    tx.bytes.assign(bytes.begin(), bytes.end());
    return tx;
}

std::optional<Chunk> decode_clock(Fields fields) {
    ClockReading clock;
    clock.raw = take_raw_time(fields);
    clock.boottime = take_instant(fields);
    clock.realtime = take_utc(fields);
    const auto state = fields.take<std::uint8_t>();
    clock.is_synchronised = (state & 1U) != 0;
    clock.leap = static_cast<timing::LeapSecond>(state >> 1U);
    clock.max_error_us = take_clock_error(fields);
    clock.estimated_error_us = take_clock_error(fields);
    if (!fields.is_used_up() || clock.leap > timing::LeapSecond::removed) return std::nullopt;
    return clock;
}

std::optional<Chunk> decode_model(Fields fields) {
    ModelChunk model;
    model.index = take_index(fields);
    model.time.utc = take_utc(fields);
    model.time.uncertainty = take_span(fields);
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
        channel.index = take_index(fields);
        channel.utc = take_utc(fields);
        mark.channels.push_back(std::move(channel));
    }
    if (!fields.is_used_up()) return std::nullopt;
    return mark;
}

std::optional<Chunk> decode_oven(Fields fields, OvenPlace place) {
    OvenChunk poll;
    poll.place = place;
    poll.time = take_raw_time(fields);
    const auto outcome = fields.take<std::uint8_t>();
    poll.outcome = static_cast<OvenOutcome>(outcome);
    poll.decimals = fields.take<std::uint8_t>();
    poll.registers.resize(fields.take<std::uint8_t>());
    for (std::uint16_t& word : poll.registers) word = fields.take<std::uint16_t>();
    if (!fields.is_used_up() || !has_registers_by_outcome(poll)) return std::nullopt;
    if (outcome >= kOvenOutcomeCount) return std::nullopt;
    return poll;
}

}  // namespace

ChunkType type_of(const Chunk& chunk) {
    const auto* const poll = std::get_if<OvenChunk>(&chunk);
    if (poll != nullptr && poll->place == OvenPlace::outer) return ChunkType::outer_oven;
    return static_cast<ChunkType>(chunk.index() + 1);
}

bool is_known(std::uint8_t type) noexcept {
    return type >= static_cast<std::uint8_t>(ChunkType::head) &&
           type <= static_cast<std::uint8_t>(ChunkType::outer_oven);
}

void append_payload(std::vector<std::byte>& out, const Chunk& chunk) {
    std::visit(PayloadWriter{out}, chunk);
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
