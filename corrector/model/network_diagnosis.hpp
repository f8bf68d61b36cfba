#pragma once
/// @file
/// What a network leaves open, and why, in words.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

/// The readings of a network: who was where, when.
struct NetworkReadings {
    std::vector<std::string> stations;    ///< Of the network.
    std::vector<bool> is_held;            ///< One per station: a datum.
    std::vector<std::size_t> station_of;  ///< One per reading, in order of time.
    std::vector<std::size_t> loop_of;     ///< One per reading.
};

/// Unknowns that rows leave open: those in which the null space of `design` has a part.  The sds of
/// the rows have no bearing on it.
[[nodiscard]] std::vector<std::size_t> open_unknowns(const Eigen::MatrixXd& design);

/// Stations that no chain of stations and loops joins to a datum: one text per group.
[[nodiscard]] std::vector<std::string> unconnected_groups(const NetworkReadings& readings);

/// Stations that only the instrument's constant and drift tie to a datum, because none is occupied
/// both before and after: `; `-joined groups, empty when there are none.
[[nodiscard]] std::string groups_tied_by_drift(const NetworkReadings& readings);

/// Whether some station was read twice in one loop.
[[nodiscard]] bool has_repeat(const NetworkReadings& readings);

}  // namespace a351::corrector
