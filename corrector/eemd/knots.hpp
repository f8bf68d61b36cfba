#pragma once
/// @file
/// Knots of the two envelopes of a sampled curve, with their continuation beyond its ends.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace a351::corrector {

/// Treatment of the envelopes at the ends of the record.  The errors of each: eemd.md, "Ends".
enum class EndRule {
    /// Both end samples are knots of both envelopes.  If an envelope has two extrema or more, the
    /// line through the two nearest an end replaces the end sample there if it is outside the data:
    /// above for maxima, below for minima.
    /// Source: Z. Wu and N. E. Huang, Adv. Adapt. Data Anal. 1(1), 1-41, 2009, section 4, as their
    /// program and libeemd (P. Luukko et al., Comput. Stat. 31, 545-557, 2016) apply it.
    line,
    /// The extrema next to an end are reflected, two of each kind.  They are reflected about the
    /// outermost one.  If the end sample is beyond the next extremum, or the reflection would not
    /// reach it, they are reflected about the end sample.  `line` if there are fewer than three
    /// extrema.
    /// Source: G. Rilling, P. Flandrin and P. Goncalves, NSIP-03, Grado, 2003.
    mirror,
};

/// The knots of the upper and the lower envelope in one list of ascending positions.  Maxima and
/// minima alternate, so knots k and k + 2 belong to the same envelope.
class AlternatingKnots {
public:
    /// Makes room for every curve of up to `sample_count` samples.
    explicit AlternatingKnots(std::size_t sample_count);

    /// Largest number of knots before the first extremum, or after the last.
    static constexpr std::size_t kMostAdded = 4;

    /// Buffers to which the search writes the extrema, see SiftKernels::find_extrema.
    struct Buffers {
        double* positions;
        double* values;
        std::uint64_t* starts;
    };
    [[nodiscard]] Buffers buffers() noexcept {
        return {positions_.data() + kMostAdded, values_.data() + kMostAdded,
                segment_starts_.data()};
    }
    /// Takes over the `count` extrema that the search wrote to buffers().
    void take(std::size_t count, bool first_is_maximum) noexcept;

    [[nodiscard]] std::size_t extrema_count() const noexcept { return extrema_count_; }
    [[nodiscard]] bool first_is_maximum() const noexcept { return first_is_maximum_; }
    [[nodiscard]] std::span<const double> extrema_values() const noexcept {
        return {values_.data() + kMostAdded, extrema_count_};
    }
    [[nodiscard]] std::span<const double> extrema_positions() const noexcept {
        return {positions_.data() + kMostAdded, extrema_count_};
    }

    /// Adds the knots at and beyond the ends of `curve`, whose extrema take() took over.
    /// Precondition: curve.size() >= 2.
    void add_ends(std::span<const double> curve, EndRule rule) noexcept;

    /// Returns true if add_ends() ended both envelopes at the last sample, not beyond.
    [[nodiscard]] bool ends_at_last_sample() const noexcept { return ends_at_last_sample_; }

    /// Returns the positions of all knots, samples from the first; valid after add_ends().
    [[nodiscard]] std::span<const double> positions() const noexcept {
        return {positions_.data() + begin_, end_ - begin_};
    }
    /// Returns the values of all knots, unit of the curve; valid after add_ends().
    [[nodiscard]] std::span<const double> values() const noexcept {
        return {values_.data() + begin_, end_ - begin_};
    }
    /// Returns a bit field.  Bit i is set if sample i is the first one at or after an extremum.
    [[nodiscard]] const std::uint64_t* segment_starts() const noexcept {
        return segment_starts_.data();
    }
    /// Returns the index of the last knot at or before sample 0.
    [[nodiscard]] std::size_t first_segment() const noexcept { return kMostAdded - begin_ - 1; }

private:
    void mirror_left_end(double sample) noexcept;
    void mirror_right_end(double sample, double last_sample) noexcept;
    void add_end_samples(std::span<const double> curve) noexcept;
    [[nodiscard]] bool is_maximum(std::size_t knot) const noexcept {
        return ((knot - kMostAdded) % 2 == 0) == first_is_maximum_;
    }

    std::vector<double> positions_;  ///< Samples from the first; half-integer on some plateaus.
    std::vector<double> values_;
    std::vector<std::uint64_t> segment_starts_;
    std::size_t extrema_count_ = 0;
    std::size_t begin_ = kMostAdded;  ///< First knot; the first extremum is element kMostAdded.
    std::size_t end_ = kMostAdded;
    bool first_is_maximum_ = true;
    bool ends_at_last_sample_ = false;
};

}  // namespace a351::corrector
