#pragma once
/// @file
/// Arrivals -> the line of the earliest ones, sample by sample.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/edge_fit.hpp"
#include "protocol/timing/sample_period.hpp"

namespace a351::timing {

/// When frames would arrive if nothing delayed them: at `arrival` for the sample `index`, and from
/// there 1 + `skew` seconds of the raw clock per nominal second of data.
struct EdgeLine {
    std::int64_t index = 0;
    RawTime arrival;
    double skew = 0.0;
    Nanoseconds uncertainty{0};  ///< 95 %, at `index`.
    double skew_uncertainty = 0.0;

    [[nodiscard]] RawTime at(std::int64_t other, const SamplePeriod& period) const {
        const Nanoseconds after = period.of(other - index);
        return arrival + after + from_seconds(skew * std::chrono::duration<double>(after).count());
    }
};

/// Keeps the blocks of the last 900 s, or of all data, and fits lines to them (fit_edge).
/// A first block of few arrivals takes no part: they may have stood unread through a sleep of the
/// host, and would be the whole line.
class ArrivalEdge {
public:
    enum class Memory { window, all };

    explicit ArrivalEdge(Hertz rate, Memory memory = Memory::window);

    /// Indices rise.
    void observe(std::int64_t index, RawTime arrival);

    /// Forgets the arrivals; for the first 300 s after it the rate is taken to be within 10 ppm of
    /// what it was, or within its uncertainty if that was larger.
    void restart();

    [[nodiscard]] bool is_empty() const noexcept { return blocks_.empty(); }

    /// 2 s are complete: an adapter's timer would have been seen.
    [[nodiscard]] bool is_settled() const noexcept { return blocks_.size() > 1; }

    /// At the newest sample when the last 2 s were complete; there is a sample.
    [[nodiscard]] const EdgeLine& line();

    /// At any sample, from the 900 s around it that are remembered; there is a sample.
    [[nodiscard]] EdgeLine line_around(std::int64_t index) const;

private:
    void close_block();
    [[nodiscard]] std::span<const ArrivalBlock> complete_blocks() const;
    [[nodiscard]] EdgeLine fit(std::span<const ArrivalBlock> blocks, std::int64_t index) const;

    SamplePeriod period_;
    Memory memory_;
    RateLimits limits_;
    RawTime zero_;
    std::int64_t newest_ = 0;
    std::vector<ArrivalBlock> blocks_;
    std::vector<Nanoseconds> open_block_;  ///< Every y of the newest block.
    bool is_first_block_ = true;           // since restart()
    std::optional<EdgeLine> line_;
};

}  // namespace a351::timing
