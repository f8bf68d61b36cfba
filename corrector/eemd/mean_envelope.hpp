#pragma once
/// @file
/// Storage of two cubic splines through alternating knots, and of their mean.
///
/// The ends are not-a-knot: the third derivative is continuous at the second and the last but one
/// knot.  An envelope of two to four knots is the polynomial through them
/// (tests/unit/eemd/mean_envelope_test.cpp).
///
/// The header has storage only.  SiftKernels::fit_mean_envelope() fills it, and
/// SiftKernels::subtract_mean_envelope() reads it:
///
///     MeanEnvelope envelope(most_knots);
///     kernels.fit_mean_envelope(x, y, knots, envelope.arrays());
///     kernels.subtract_mean_envelope(curve, out, n, starts, x, first_segment, envelope.arrays());
///
/// The knots of both envelopes are in one list and alternate between them (AlternatingKnots).  Half
/// the sum of two splines is a cubic between neighbouring knots, so one cubic per knot describes
/// it.

#include <cstddef>

#include "corrector/eemd/aligned_buffer.hpp"

namespace a351::corrector::eemd {

/// Arrays with one number per knot.
///
/// The pointers refer to the memory of a MeanEnvelope and are valid as long as it.  No two arrays
/// overlap.  Element k belongs to knot k; positions are in samples, values Y in the unit of the
/// curve.
///
/// The arrays inverse to link are the equations of both splines.
///
/// Only mean_y, mean_b, mean_c and mean_e are results.  They are set for 1 <= k <= n - 3, where n
/// is the number of knots; all other elements are undefined.
struct SplineArrays {
    double* inverse;  ///< 1 / (X_{k+2} - X_k) of knots at (X, Y); k + 2 is on the same envelope
    double* slope;    ///< (Y_{k+2} - Y_k) / (X_{k+2} - X_k)
    double* link;     ///< elimination, see spline_loops.hpp
    double* c;        ///< half the second derivative at a knot
    double* mean_y;   ///< Y_k + d (b_k + d (c_k + d e_k)), d = t - X_k, from X_k to X_{k+1}, k >= 1
    double* mean_b;
    double* mean_c;
    double* mean_e;
};

/// Owns the arrays for up to `most_knots` knots.
///
/// One object serves any number of fits, one after the other; nothing remains of the fit before.
/// It can be moved, but not copied.
class MeanEnvelope {
public:
    /// Allocates eight arrays, with room for the elements that vector loops read beyond the last
    /// knot.
    /// @param most_knots  largest number of knots of a fit, both envelopes together.
    /// @throws std::bad_alloc  if there is not so much memory.
    explicit MeanEnvelope(std::size_t most_knots);
    MeanEnvelope(MeanEnvelope&&) = default;  // a copy's pointers would be the original's
    /// Returns the pointers to the arrays.  They stay valid if this object is moved, because the
    /// memory moves along.
    [[nodiscard]] const SplineArrays& arrays() const noexcept { return arrays_; }

private:
    AlignedBuffer storage_;
    SplineArrays arrays_;
};

}  // namespace a351::corrector::eemd
