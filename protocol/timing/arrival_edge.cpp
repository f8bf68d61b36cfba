#include "protocol/timing/arrival_edge.hpp"

#include <utility>

#include "protocol/core/invariant.hpp"

namespace a351::timing {
namespace {

using std::chrono::seconds;

constexpr std::int64_t kBlock_s = 2;
constexpr Nanoseconds kWindow = seconds(900);  // 600 to 1200 s differ little

// A fifth of a block: 0.4 s of data.  A kernel buffers less for a host that falls asleep, unless
// the host was busy.
constexpr std::int64_t kFewShare = 5;

// Arrivals of a block needed for its spacing; the largest step of fewer is not significant.
constexpr std::size_t kFewestOfBlock = 20;

constexpr double kKeptRate = 10e-6;  // change of the rate in a sleep: sensor or host grew cold
constexpr Nanoseconds kRateKnown = seconds(300);

}  // namespace

ArrivalEdge::ArrivalEdge(Hertz rate, Memory memory) : period_(rate), memory_(memory) {}

void ArrivalEdge::observe(std::int64_t index, RawTime arrival) {
    require_invariant(blocks_.empty() || index > newest_, "arrivals have ascending indices");
    newest_ = index;
    const Nanoseconds due = period_.of(index);
    if (blocks_.empty()) zero_ = arrival - due;
    const Nanoseconds y = arrival - zero_ - due;
    const std::int64_t number = index / (kBlock_s * period_.per_second());
    if (blocks_.empty() || number != blocks_.back().number) {
        if (!blocks_.empty()) close_block();
        blocks_.push_back({number, due, y, std::nullopt});
    } else if (y < blocks_.back().least_y) {
        blocks_.back().due = due;
        blocks_.back().least_y = y;
    }
    open_block_.push_back(y);
    if (!is_settled()) line_.reset();
}

void ArrivalEdge::close_block() {
    const auto count = static_cast<std::int64_t>(open_block_.size());
    const std::int64_t few = kBlock_s * period_.per_second() / kFewShare;
    if (std::exchange(is_first_block_, false) && count < few) {
        blocks_.clear();
        open_block_.clear();
        return;
    }
    std::ranges::sort(open_block_);
    if (open_block_.size() >= kFewestOfBlock) {
        Nanoseconds largest{0};
        for (std::size_t i = 1; i < open_block_.size() * 9 / 10; ++i)
            largest = std::max(largest, open_block_[i] - open_block_[i - 1]);
        blocks_.back().spacing = largest;
    }
    open_block_.clear();
    line_.reset();
    if (memory_ == Memory::all) return;
    const Nanoseconds oldest = period_.of(newest_) - kWindow;
    blocks_.erase(blocks_.begin(),
                  std::find_if(blocks_.begin(), blocks_.end(),
                               [&](const ArrivalBlock& b) { return b.due >= oldest; }));
}

void ArrivalEdge::restart() {
    if (is_settled()) {
        const EdgeLine last = line();
        const double half = std::max(last.skew_uncertainty, kKeptRate);
        limits_ = {std::max(last.skew - half, -RateLimits::kLargest),
                   std::min(last.skew + half, RateLimits::kLargest)};
    }
    blocks_.clear();
    open_block_.clear();
    line_.reset();
    is_first_block_ = true;
}

// The least delayed frame of the newest block may still be to come.
std::span<const ArrivalBlock> ArrivalEdge::complete_blocks() const {
    return std::span(blocks_).first(is_settled() ? blocks_.size() - 1 : blocks_.size());
}

const EdgeLine& ArrivalEdge::line() {
    if (!line_) line_ = fit(complete_blocks(), newest_);
    return *line_;
}

EdgeLine ArrivalEdge::line_around(std::int64_t index) const {
    const auto blocks = complete_blocks();
    const Nanoseconds latest_start = std::max(blocks.back().due - kWindow, blocks.front().due);
    const Nanoseconds from =
        std::clamp(period_.of(index) - kWindow / 2, blocks.front().due, latest_start);
    const auto begin = std::ranges::lower_bound(blocks, from, {}, &ArrivalBlock::due);
    const auto end =
        std::ranges::lower_bound(begin + 1, blocks.end(), from + kWindow, {}, &ArrivalBlock::due);
    return fit({begin, end}, index);
}

EdgeLine ArrivalEdge::fit(std::span<const ArrivalBlock> blocks, std::int64_t index) const {
    const Nanoseconds due = period_.of(index);
    // The rate known before a restart helps until the arrivals determine it better.
    const bool knows_rate = blocks.back().due - blocks.front().due >= kRateKnown;
    const RateLimits limits = knows_rate ? RateLimits{} : limits_;
    const EdgeFit fit = fit_edge(blocks, due, period_.of(1), limits);
    return {index, zero_ + due + fit.y, fit.skew, fit.uncertainty, fit.skew_uncertainty};
}

}  // namespace a351::timing
