#pragma once
/// @file
/// The face of a set-up: which side of the box is up.  Daemon and corrector use this one rule.
///
///     const std::size_t vertical = vertical_axis(sizes);     // the one along gravity
///     if (const auto face = face_of(means[vertical])) ...    // 1 or -1, shown as sign_of(*face)

#include <array>
#include <optional>
#include <string_view>

#include "protocol/core/units.hpp"

namespace a351::events {

/// Least mean of the vertical axis in size, g.  Reason: less means more than 25 deg from the vertical,
/// so the box is not level.
inline constexpr StandardGravity kLeastVertical{0.9};

/// What is said of the face of a set-up.  The data decide which one it is.
struct StatedFace {
    std::optional<int> entered = {};  ///< Face that the operator entered.
    std::optional<int> planned = {};  ///< Face in the plan of the daemon.
    /// Returns the face to be expected: the one entered, or else the planned one.
    [[nodiscard]] std::optional<int> expected() const { return entered ? entered : planned; }
};

/// Reason why a set-up has no face.
extern const char* const kOnItsSide;

/// Returns the number of the axis that is along gravity: its mean is nearest to 1 g in size.
[[nodiscard]] std::size_t vertical_axis(const std::array<double, 3>& means_g);

/// Returns the face by the mean of the vertical axis: 1 if it points up, -1 if the box is turned over;
/// std::nullopt if the mean is less than kLeastVertical in size.
[[nodiscard]] std::optional<int> face_of(StandardGravity mean);

/// Returns "+" or "-".
[[nodiscard]] std::string_view sign_of(int face);

/// Reads a face that a person entered.
/// @return std::nullopt unless it is "+" or "-".
[[nodiscard]] std::optional<int> parse_face(std::string_view sign);

}  // namespace a351::events
