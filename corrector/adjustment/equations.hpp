#pragma once
/// @file
/// The observation equations of an adjustment, as they are written in a textbook of geodesy:
///
///     value_i = f_i g(station_i) + sum_k a_ik t_k + error_i,   error_i of standard deviation sd_i
///
/// g are the gravities of the stations, t the terms of the instrument.  A reading touches one
/// station and a few terms, so an equation lists only those.  A reference that is known with an
/// uncertainty is an equation of its own, and so is the prior of a term.  A reference that is held
/// exactly has no unknown: its gravity is on the left side.
///
/// Units: the value of a reading or a reference is in mGal, that of a prior in the unit of its term.

#include <cstddef>
#include <vector>

namespace a351::corrector::adjustment {

/// A number of an unknown and its factor.
struct Entry {
    std::size_t unknown = 0;
    double factor = 0.0;
};

/// A linear combination of unknowns: stations are numbered first, then terms.
using Combination = std::vector<Entry>;

/// An observation: a reading, a reference or a prior.
struct Equation {
    double value = 0.0;     ///< y.
    double sd = 1.0;        ///< Standard deviation a priori, > 0.
    Combination unknowns;   ///< At most one of them is a station.
    bool is_reading = true; ///< False for references and priors, whose sd is not that of readings.
    /// True standard deviation / sd: above 1 for a coefficient that is held at its prior.
    double true_ratio = 1.0;
};

/// A system of equations.
struct Equations {
    std::size_t stations = 0;  ///< Number of the gravities.
    std::size_t terms = 0;     ///< Number of the terms.
    std::vector<Equation> rows;

    /// Returns the number of the unknown of a term.
    [[nodiscard]] std::size_t unknown_of_term(std::size_t term) const { return stations + term; }
};

}  // namespace a351::corrector::adjustment
