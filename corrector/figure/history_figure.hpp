#pragma once
/// @file
/// Figure of a unit's terms over its days.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/result/unit_history.hpp"

namespace a351::corrector::figure {

/// Returns the figure of constant, both slopes and placement by day, with bars of one standard
/// uncertainty.  A panel without values is left out.
/// @param days  sorted by unit and time; at least one.  Each unit has its own colour.
[[nodiscard]] Figure history_figure(const std::vector<result::UnitDay>& days, const Print& print);

}  // namespace a351::corrector::figure
