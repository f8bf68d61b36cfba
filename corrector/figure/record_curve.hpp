#pragma once
/// @file
/// Curves of long records over hours, and their common texts.

#include <cstddef>
#include <span>
#include <string>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector::figure {

/// Most steps of a curve.  Reason: two to three per pixel.
inline constexpr std::size_t kMostSteps = 1500;

/// A curve over hours: sample i is at first_h + i step_h and has factor * (value - offset).
struct Curve {
    std::span<const double> values;
    double step_h, first_h = 0.0, offset = 0.0, factor = 1.0;
};

/// Returns the least and the greatest value of every step; one value if a step is one sample.
[[nodiscard]] std::string curve_lines(const Curve& curve);

/// Returns the label of an axis in hours.
[[nodiscard]] std::string hours_after(UtcTime start);

[[nodiscard]] double step_h_of(const long_record::RecordResult& result);

/// Returns the published value of a statistic (record_statistics()), for a caption.
[[nodiscard]] std::string published_value(const long_record::RecordResult& result,
                                          std::string_view key);

/// The chosen modes, with the acceleration's sign reversed and moved earlier by the shift.
struct ModePair {
    std::vector<double> temperature, turned;
};

/// Returns true if the chosen modes and the shift are those of the publication, so that both can be
/// compared: the sixth modes, with periods of 600 to 900 s, moved by 280 s.
[[nodiscard]] bool is_published_pair(const long_record::RecordResult& result);

/// @pre analysis.modes
[[nodiscard]] ModePair mode_pair(const long_record::RecordResult& result);

/// Returns the figure of all modes of both series with their periods.
[[nodiscard]] Figure decomposition_figure(const long_record::RecordResult& result,
                                          const Print& print);
/// Returns the figure of the two chosen modes over each other.
[[nodiscard]] Figure overlay_figure(const long_record::RecordResult& result, const ModePair& pair,
                                    const Print& print);
/// Returns the figure of their cross-correlation, with the limits of chance.
[[nodiscard]] Figure correlation_figure(const long_record::RecordResult& result,
                                        const Print& print);

}  // namespace a351::corrector::figure
