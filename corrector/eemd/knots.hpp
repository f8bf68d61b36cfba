#pragma once
/// @file
/// Knots of the two envelopes of a sampled curve, with their continuation beyond its ends.
///
/// A spline needs knots at both ends of the record, or beyond them.  Otherwise it would be
/// extrapolated from the outermost extremum to the end, where a cubic can become arbitrarily large.
///
/// EndRule is for callers of eemd().  AlternatingKnots is a part of EmdWorkspace; the order of
/// calls for one sift is:
///
///     const auto [positions, values, starts] = knots.buffers();
///     const std::size_t count = kernels.find_extrema(curve, n, positions, values, starts);
///     knots.take(count, count > 0 && values[0] > curve[0]);
///     knots.add_ends({curve, n}, EndRule::line);
///     use(knots.positions(), knots.values());

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace a351::corrector::eemd {

/// Treatment of the envelopes at the ends of the record.  The errors of each: eemd.md, "Ends".
///
/// Results with `line` compare with those of libeemd and of the literature.  The rule `mirror` has
/// smaller errors at the ends; the trend of an occupation is made with it.  Neither makes up for a
/// disturbed end: despike first, or use Options::reflect_ends.
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
///
/// Invariant: after add_ends() there are at least two knots per envelope, and their positions do
/// not decrease.  Pointers and spans are valid until the object is destroyed; their content changes
/// with take() and add_ends().  Only the constructor allocates.
///
/// A new object has no extrema.  An object may be used by one thread at a time.
class AlternatingKnots {
public:
    /// Makes room for every curve of up to `sample_count` samples.
    /// @throws std::bad_alloc  if there is not so much memory.
    explicit AlternatingKnots(std::size_t sample_count);

    /// Largest number of knots before the first extremum, or after the last.
    static constexpr std::size_t kMostAdded = 4;

    /// Buffers to which the search writes the extrema, see SiftKernels::find_extrema.
    struct Buffers {
        /// Positions, samples from the first; room for sample_count + 12 elements.
        double* positions;
        /// Values, unit of the curve; room as for the positions.
        double* values;
        /// Bit field of segment_starts(), (sample_count / 64 + 2) words.
        std::uint64_t* starts;
    };
    /// Returns the buffers, which this object owns.  The search overwrites the extrema of the curve
    /// before.
    [[nodiscard]] Buffers buffers() noexcept {
        return {positions_.data() + kMostAdded, values_.data() + kMostAdded,
                segment_starts_.data()};
    }
    /// Takes over the `count` extrema that the search wrote to buffers(), and removes added knots.
    /// @param count  number of extrema, at most sample_count.
    /// @param first_is_maximum  true if the first extremum is a maximum; without extrema any value.
    void take(std::size_t count, bool first_is_maximum) noexcept;

    /// Returns the number of extrema, without the knots that add_ends() added.
    [[nodiscard]] std::size_t extrema_count() const noexcept { return extrema_count_; }
    /// Returns true if the first extremum is a maximum; the kinds alternate from there.
    [[nodiscard]] bool first_is_maximum() const noexcept { return first_is_maximum_; }
    /// Returns the values of the extrema, (extrema_count()), unit of the curve.
    [[nodiscard]] std::span<const double> extrema_values() const noexcept {
        return {values_.data() + kMostAdded, extrema_count_};
    }
    /// Returns the positions of the extrema, samples from the first.  A position is an integer, or
    /// ends in 0.5 for a plateau of an even number of samples.
    [[nodiscard]] std::span<const double> extrema_positions() const noexcept {
        return {positions_.data() + kMostAdded, extrema_count_};
    }

    /// Adds the knots at and beyond the ends of `curve`, whose extrema take() took over.
    /// With `line` these are two knots at the first sample and two at the last, one per envelope.
    /// With `mirror` they are up to kMostAdded at either end, and may be beyond the samples.
    ///
    /// Works also without extrema: both envelopes are then the line from the first to the last
    /// sample.  A second call replaces the added knots.  Examples:
    /// tests/unit/eemd/extrema_test.cpp.
    /// Precondition: curve.size() >= 2.
    void add_ends(std::span<const double> curve, EndRule rule) noexcept;

    /// Returns true if add_ends() ended both envelopes at the last sample, not beyond.
    /// The caller must then compute the last sample itself, because cubics end before it.
    [[nodiscard]] bool ends_at_last_sample() const noexcept { return ends_at_last_sample_; }

    /// Returns the positions of all knots, samples from the first; valid after add_ends().
    /// They begin at or before sample 0.  Equal positions occur only at the ends, for knots of
    /// different envelopes.
    [[nodiscard]] std::span<const double> positions() const noexcept {
        return {positions_.data() + begin_, end_ - begin_};
    }
    /// Returns the values of all knots, unit of the curve; valid after add_ends().
    [[nodiscard]] std::span<const double> values() const noexcept {
        return {values_.data() + begin_, end_ - begin_};
    }
    /// Returns a bit field.  Bit i is set if sample i is the first one at or after an extremum.
    /// Bit i is bit i % 64 of word i / 64.  The field has sample_count / 64 + 2 words; the search
    /// wrote it.
    [[nodiscard]] const std::uint64_t* segment_starts() const noexcept {
        return segment_starts_.data();
    }
    /// Returns the index of the last knot at or before sample 0.
    [[nodiscard]] std::size_t first_segment() const noexcept { return kMostAdded - begin_ - 1; }

private:
    /// Adds the extrema reflected at one end.
    /// @param end, sample  position and value of the end sample.
    /// @param inwards      1 at the first sample, -1 at the last.
    void mirror_end(double end, double sample, std::ptrdiff_t inwards) noexcept;
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

}  // namespace a351::corrector::eemd
