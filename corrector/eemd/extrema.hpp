#pragma once
/// @file
/// Extrema of a sampled curve, and the knots they make for its envelopes.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Knots of one envelope: left end, interior extrema, right end.  Capacity is fixed at construction.
class EnvelopeKnots {
public:
    /// Room for every curve of up to `sample_count` samples.
    explicit EnvelopeKnots(std::size_t sample_count);

    [[nodiscard]] std::size_t extrema_count() const noexcept { return extrema_count_; }

    /// Interior extrema, in samples from the first one; half an odd number on a plateau of even length.
    [[nodiscard]] std::span<const double> extrema_positions() const noexcept {
        return {positions_.data() + 1, extrema_count_};
    }
    [[nodiscard]] std::span<const double> extrema_values() const noexcept {
        return {values_.data() + 1, extrema_count_};
    }

    /// All knots; valid after add_end_knots().
    [[nodiscard]] std::span<const double> positions() const noexcept {
        return {positions_.data(), extrema_count_ + 2};
    }
    [[nodiscard]] std::span<const double> values() const noexcept {
        return {values_.data(), extrema_count_ + 2};
    }

private:
    friend void find_extrema(std::span<const double>, EnvelopeKnots&, EnvelopeKnots&) noexcept;
    friend void add_end_knots(std::span<const double>, EnvelopeKnots&, EnvelopeKnots&) noexcept;

    std::vector<double> positions_;
    std::vector<double> values_;
    std::size_t extrema_count_ = 0;
};

/// Finds the interior maxima and minima of `curve`.  A plateau between a rise and a fall is one
/// extremum at its middle; a plateau that touches either end is none.  Maxima and minima alternate.
///
/// Precondition: both knots have room for curve.size() samples.
void find_extrema(std::span<const double> curve, EnvelopeKnots& maxima,
                  EnvelopeKnots& minima) noexcept;

/// Makes both end samples knots of both envelopes.  Where an envelope has two extrema or more, the
/// line through the two nearest an end takes the place of the end sample if it lies outside the
/// data there: above for maxima, below for minima.
///
/// Precondition: find_extrema() ran on the same curve; curve.size() >= 2.
/// Source: the rule of Z. Wu and N. E. Huang, Adv. Adapt. Data Anal. 1(1), 1-41, 2009, section 4, as
/// their program and libeemd (Luukko et al., Comput. Stat. 31, 545-557, 2016) apply it.
void add_end_knots(std::span<const double> curve, EnvelopeKnots& maxima,
                   EnvelopeKnots& minima) noexcept;

/// Number of interior maxima and minima of `curve`.
[[nodiscard]] std::size_t count_extrema(std::span<const double> curve) noexcept;

/// Middles of the interior extrema of `curve`, rounded down, in ascending order.
[[nodiscard]] std::vector<std::size_t> extremum_indices(std::span<const double> curve);

}  // namespace a351::corrector
