#pragma once
/// @file
/// Ranges and ticks of logarithmic axes.
///
/// gnuplot 6 (Debian 13) puts linear ticks on a logarithmic axis with fewer than three powers of ten,
/// version 5.4 (Debian 12) has numbers at powers of ten only.  So an axis of less than three decades
/// gets its ticks here, and its range too.

#include <array>
#include <string>

#include "corrector/figure/figure.hpp"

namespace a351::corrector::figure {

/// Sets the ends of the ranges of x, y and colours that follow from the figure's data, if the axis is
/// logarithmic: the powers of ten around its positive values.  Limits of values count, u and tiles do
/// not.  An axis without such values, or whose data are in another figure, keeps its range.
void set_decades(Panel& panel, const Figure& figure);

/// Returns the ticks in gnuplot's words: numbers at powers of ten, below two decades also at 2 and
/// 5, below a factor 5 at all digits, and small ticks at the other digits.  Empty from three decades
/// on, without a range, and if only one number would be on the axis.
[[nodiscard]] std::string logarithmic_ticks(const std::array<double, 2>& range);

}  // namespace a351::corrector::figure
