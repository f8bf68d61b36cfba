#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/wire/burst_decoder.hpp"

namespace {

using namespace a351;

constexpr int kFrames = 50000;

/// Returns frames of a quiet sensor, with a few counts of noise from a linear congruential
/// generator.
std::vector<std::byte> stream() {
    std::vector<std::byte> bytes;
    std::uint32_t state = 1;
    const auto noise = [&state] {
        state = state * 1664525u + 1013904223u;
        return static_cast<std::int32_t>(state >> 27) - 16;
    };
    for (int i = 0; i < kFrames; ++i) {
        wire::BurstValues values;
        values.flag = 0x8E00;
        values.temperature = -1981 + noise() / 8;
        values.axes = {noise(), noise(), (1 << 24) + noise()};
        values.count = static_cast<std::uint16_t>(80 * (i + 1));
        wire::append_frame(wire::BurstLayout::recommended(), values, bytes);
    }
    return bytes;
}

void decode_stream(benchmark::State& state) {
    const auto bytes = stream();
    for (auto _ : state) {
        wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
        std::span<const std::byte> input = bytes;
        while (auto event = decoder.next(input)) benchmark::DoNotOptimize(event);
    }
    state.SetItemsProcessed(state.iterations() * kFrames);
}
BENCHMARK(decode_stream)->Unit(benchmark::kMillisecond);

struct Discard : archive::Sink {
    void record(const std::string&, const archive::PackedRecord&, std::int64_t) override {}
};

void archive_stream(benchmark::State& state) {
    const auto bytes = stream();
    journal::Header header;
    header.profile = "A351";
    header.output_rate_hz = 50;
    header.filter = "k512_fc9";
    header.burst_ctrl = 0xC703;
    header.baud = 460800;
    constexpr std::size_t kFramesPerChunk = 50;
    constexpr std::size_t kChunk = kFramesPerChunk * 24;
    for (auto _ : state) {
        Discard sink;
        archive::Archiver archiver(sink);
        archiver.take(header);
        archiver.take(header.clock);
        for (std::size_t at = 0; at < bytes.size(); at += kChunk) {
            journal::RxChunk chunk;
            const auto end = std::min(at + kChunk, bytes.size());
            chunk.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                               bytes.begin() + static_cast<std::ptrdiff_t>(end));
            chunk.reads.push_back({static_cast<std::uint32_t>(end - at),
                                   RawTime(std::chrono::milliseconds(20 * end / 24))});
            archiver.take(chunk);
        }
        archiver.close_records();
    }
    state.SetItemsProcessed(state.iterations() * kFrames);
}
BENCHMARK(archive_stream)->Unit(benchmark::kMillisecond);

}  // namespace
