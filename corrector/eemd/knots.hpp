#pragma once
/// @file
/// Knots of the two envelopes of a sampled curve, and what continues them beyond its ends.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace a351::corrector {

/// How the envelopes are held at the ends of the record.
enum class EndRule {
    /// Both end samples are knots of both envelopes; where an envelope has two extrema or more, the
    /// line through the two nearest an end takes the place of the end sample if it lies outside the
    /// data there: above for maxima, below for minima.
    /// Source: Z. Wu and N. E. Huang, Adv. Adapt. Data Anal. 1(1), 1-41, 2009, section 4, as their
    /// program and libeemd (P. Luukko et al., Comput. Stat. 31, 545-557, 2016) apply it.
    line,
    /// The extrema next to an end are reflected: about the outermost one, or about the end sample
    /// where that lies beyond the next extremum or the reflection would not reach it.  Two of each
    /// kind; `line` for a curve of fewer than three extrema.
    /// Source: G. Rilling, P. Flandrin and P. Goncalves, NSIP-03, Grado, 2003.
    mirror,
    /// End samples are knots as they are.  For comparison only: the error grows inwards.
    pinned,
};

/// Maxima and minima alternate, and so do the knots of the upper and the lower envelope in one list
/// of ascending positions: knots k and k + 2 belong to the same envelope.
class AlternatingKnots {
public:
    /// Room for every curve of up to `sample_count` samples.
    explicit AlternatingKnots(std::size_t sample_count);

    /// Knots that can stand before the first extremum or after the last.
    static constexpr std::size_t kMostAdded = 4;

    /// Where the search writes the extrema, see SiftKernels::find_extrema.
    struct Buffers {
        double* positions;
        double* values;
        std::uint64_t* starts;
    };
    [[nodiscard]] Buffers buffers() noexcept {
        return {positions_.data() + kMostAdded, values_.data() + kMostAdded,
                segment_starts_.data()};
    }
    /// The search wrote `count` extrema.
    void take(std::size_t count, bool first_is_maximum) noexcept;

    [[nodiscard]] std::size_t extrema_count() const noexcept { return extrema_count_; }
    [[nodiscard]] bool first_is_maximum() const noexcept { return first_is_maximum_; }
    [[nodiscard]] std::span<const double> extrema_values() const noexcept {
        return {values_.data() + kMostAdded, extrema_count_};
    }
    [[nodiscard]] std::span<const double> extrema_positions() const noexcept {
        return {positions_.data() + kMostAdded, extrema_count_};
    }

    /// Adds the knots at and beyond the ends of `curve`, which take() told the extrema of.
    /// Precondition: curve.size() >= 2.
    void add_ends(std::span<const double> curve, EndRule rule) noexcept;

    /// Whether add_ends() ended both envelopes at the last sample, not beyond.
    [[nodiscard]] bool ends_at_last_sample() const noexcept { return ends_at_last_sample_; }

    /// All knots; valid after add_ends().
    [[nodiscard]] std::span<const double> positions() const noexcept {
        return {positions_.data() + begin_, end_ - begin_};
    }
    [[nodiscard]] std::span<const double> values() const noexcept {
        return {values_.data() + begin_, end_ - begin_};
    }
    /// Bit i of the words: the first sample at or after an extremum is sample i.
    [[nodiscard]] const std::uint64_t* segment_starts() const noexcept {
        return segment_starts_.data();
    }
    /// Index of the last knot at or before sample 0.
    [[nodiscard]] std::size_t first_segment() const noexcept { return kMostAdded - begin_ - 1; }

private:
    void mirror_left_end(double sample) noexcept;
    void mirror_right_end(double sample, double last_sample) noexcept;
    void add_end_samples(std::span<const double> curve, EndRule rule) noexcept;
    [[nodiscard]] bool is_maximum(std::size_t knot) const noexcept {
        return ((knot - kMostAdded) % 2 == 0) == first_is_maximum_;
    }

    std::vector<double> positions_;  ///< In samples from the first; half an odd number on plateaus.
    std::vector<double> values_;
    std::vector<std::uint64_t> segment_starts_;
    std::size_t extrema_count_ = 0;
    std::size_t begin_ = kMostAdded;  ///< First extremum: always element kMostAdded.
    std::size_t end_ = kMostAdded;
    bool first_is_maximum_ = true;
    bool ends_at_last_sample_ = false;
};

}  // namespace a351::corrector
