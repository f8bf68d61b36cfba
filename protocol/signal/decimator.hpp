#pragma once
/// @file
/// Decimation of a series that arrives in pieces, in memory that does not grow with it.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "protocol/signal/decimation.hpp"
#include "protocol/signal/tap_pairs.hpp"

namespace a351::corrector {

/// decimate() for a stream.  Where the caller cuts the stream changes no bit of any output.
///
///     for (const auto& block : blocks) decimator.push(block, output);
///     decimator.finish(output);
///
/// Polyphase: sample i is kept in row i mod M, so that the outputs k, k + 1, ... read neighbouring
/// columns of each row and are computed side by side, each in the order of terms of the definition.
/// Memory per stage: about 100 M numbers.
/// Source: R. E. Crochiere and L. R. Rabiner, Multirate Digital Signal Processing, Prentice-Hall,
/// 1983, section 3.3 (polyphase structures).
class Decimator {
public:
    /// @param stages  >= 1: the output of one is the input of the next.
    /// @throws std::invalid_argument  fewer.
    explicit Decimator(const DecimationFilter& filter, int stages = 1);

    /// Takes the next samples and appends every output that is complete with them.
    /// @throws std::logic_error  after finish().
    void push(std::span<const double> input, std::vector<double>& output);

    /// The input ends: appends the outputs that reach beyond it.
    /// @throws std::logic_error  the second time.
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
        std::size_t column_count_;    ///< For samples.
        std::size_t row_size_;        ///< The columns and what the last outputs may read beyond.
        std::vector<TapPair> pairs_;  ///< From the outermost taps inwards.
        TapPair centre_;              ///< left == right
        std::vector<double> phases_;  ///< (factor_, row_size_), row by row.
        SumTapPairs sum_tap_pairs_;
        std::size_t stored_ = 0;   ///< Samples in phases_, NaN before the first one included.
        std::size_t emitted_ = 0;  ///< Outputs made from what phases_ holds.
    };

    void require_unfinished() const;
    void push_from(std::size_t k, std::span<const double> input, std::vector<double>& output);

    std::vector<Stage> stages_;
    std::vector<std::vector<double>> made_;  ///< By each stage from the last push; kept for reuse.
    bool is_finished_ = false;
};

}  // namespace a351::corrector
