#pragma once
/// @file
/// Storage of two cubic splines through alternating knots, and of their mean.
///
/// The ends are not-a-knot: the third derivative is continuous at the second and the last but one
/// knot.  An envelope of two to four knots is the polynomial through them
/// (tests/unit/eemd/mean_envelope_test.cpp).

#include <cstddef>

#include "corrector/eemd/aligned_buffer.hpp"

namespace a351::corrector {

/// Arrays with one number per knot; b and e may be overwritten after the mean is made.
struct SplineArrays {
    double* h;        ///< X_{k+2} - X_k of knots at (X, Y); k + 2 is on the same envelope
    double* inverse;  ///< 1 / h_k
    double* slope;    ///< (Y_{k+2} - Y_k) / h_k
    double* pivot;    ///< elimination, see spline_loops.hpp
    double* link;     ///< elimination, see spline_loops.hpp
    double* c;        ///< half the second derivative at a knot
    double* b;        ///< S = Y_k + d (b_k + d (c_k + d e_k)), d = t - X_k
    double* e;        ///< see b
    double* mean_y;   ///< the same for the mean of both envelopes, from X_k to X_{k+1}, k >= 1
    double* mean_b;
    double* mean_c;
    double* mean_e;
};

/// Owns the arrays for up to `most_knots` knots.
class MeanEnvelope {
public:
    explicit MeanEnvelope(std::size_t most_knots);
    MeanEnvelope(MeanEnvelope&&) = default;  // a copy's pointers would be the original's
    [[nodiscard]] const SplineArrays& arrays() const noexcept { return arrays_; }

private:
    AlignedBuffer storage_;
    SplineArrays arrays_;
};

}  // namespace a351::corrector
