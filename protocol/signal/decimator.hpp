#pragma once
/// @file
/// Decimation of a series that arrives in pieces; memory does not grow with its length.
///
/// Use it for a file that is too long for memory, or for live data.  For a series in memory
/// decimate() is shorter to write.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "protocol/signal/decimation.hpp"
#include "protocol/signal/tap_pairs.hpp"

namespace a351::signal {

/// Decimates a stream, with the outputs of decimate().  They do not depend on how the caller cuts
/// the stream.
///
///     for (const auto& block : blocks) decimator.push(block, output);
///     decimator.finish(output);
///
/// A stream of n samples gives ceil(n / M) outputs after each stage, finish() included.  A
/// decimator serves one stream; use a new one for the next.  Memory also grows with the largest
/// block, so cut a long stream.  Not thread-safe.
///
/// Method: polyphase.  Sample i is kept in row i mod M, so that outputs k, k + 1, ... read
/// neighbouring columns of each row.  They are computed side by side, each in the order of terms of
/// the definition.  Memory per stage: about 100 x factor numbers.
///
/// Accuracy: for any factor, length and cut of the stream the outputs have the same bits as the
/// plain sum from the outermost pair of taps inwards (decimator_test.cpp).  Missing values and
/// range are those of decimate().
///
/// Source: R. E. Crochiere and L. R. Rabiner, Multirate Digital Signal Processing, Prentice-Hall,
/// 1983, section 3.3 (polyphase structures).
class Decimator {
public:
    /// Begins a stream.  The taps are copied, so `filter` need not outlive this.
    /// @param filter  from design_decimation(); not checked.
    /// @param stages  >= 1; the output of one stage is the input of the next.
    /// @throws std::invalid_argument  `stages` is below 1.
    explicit Decimator(const DecimationFilter& filter, int stages = 1);

    /// Takes the next samples (n >= 0) and appends every output that is complete with them: an
    /// output comes with the last sample it needs.
    ///
    /// The first outputs are NaN, because they need samples before the begin.  A NaN or infinite
    /// sample makes those outputs NaN that use it.  Cost: O(n).
    /// @param input   x (n), any unit, magnitude at most 1e307.
    /// @param output  grows at its end; earlier elements are unchanged.
    /// @throws std::logic_error  called after finish().
    void push(std::span<const double> input, std::vector<double>& output);

    /// Ends the input and appends the remaining outputs, which are NaN because they need samples
    /// after the end.  Leave it out if these outputs are not needed.
    /// @throws std::logic_error  called twice.
    void finish(std::vector<double>& output);

private:
    class Stage {
    public:
        explicit Stage(const DecimationFilter& filter);
        void push(std::span<const double> input, std::vector<double>& output);
        void finish(std::vector<double>& output);

    private:
        using Outputs = std::array<double, kSideBySide>;

        void store(std::span<const double> input);
        void emit(std::vector<double>& output);
        void make_room();
        [[nodiscard]] Outputs filter_from(std::size_t first) const;
        [[nodiscard]] std::size_t capacity() const noexcept { return factor_ * column_count_; }

        std::size_t factor_;
        std::size_t half_width_;
        std::size_t column_count_;    ///< Columns for samples.
        std::size_t row_size_;        ///< Columns, and those that the last outputs read in excess.
        std::vector<TapPair> pairs_;  ///< From the outermost taps inwards.
        TapPair centre_;              ///< Middle tap: left == right.
        std::vector<double> phases_;  ///< (factor_, row_size_), row by row.
        SumTapPairs sum_tap_pairs_;
        std::size_t stored_ = 0;   ///< Samples in phases_, NaN before the first one included.
        std::size_t emitted_ = 0;  ///< Outputs made from what phases_ holds.
    };

    void require_unfinished() const;
    void push_from(std::size_t k, std::span<const double> input, std::vector<double>& output);

    std::vector<Stage> stages_;
    std::vector<std::vector<double>> made_;  ///< Outputs of each stage; kept to reuse the memory.
    bool is_finished_ = false;
};

}  // namespace a351::signal
