#pragma once
/// @file
/// Unknowns that a network does not determine, and the reasons in words.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

/// The readings of a network: station and loop of each.
struct NetworkReadings {
    std::vector<std::string> stations;    ///< (s) Names of the stations of the network.
    std::vector<bool> is_held;            ///< (s) True for a datum.
    std::vector<std::size_t> station_of;  ///< Number of the station of each reading, by time.
    std::vector<std::size_t> loop_of;     ///< Number of the loop of each reading.
};

/// Returns the numbers of the unknowns that the rows do not determine: those that have a component
/// in the null space of `design`.
///
/// Columns are scaled to length 1 first, so that units have no effect.  Singular values up to 1e-9
/// of the largest count as 0.  The standard deviations of the rows have no effect and are not
/// needed.
/// @param design  (rows, unknowns), finite; may have fewer rows than unknowns.
[[nodiscard]] std::vector<std::size_t> undetermined_unknowns(const Eigen::MatrixXd& design);

/// Returns the groups of stations that no chain of stations and loops connects with a datum, as one
/// text of joined names per group; empty if there are none.
[[nodiscard]] std::vector<std::string> unconnected_groups(const NetworkReadings& readings);

/// Returns the groups of stations that only the instrument's constant and drift connect with a
/// datum, because no station is occupied both before and after.  Groups are joined by `; `; empty
/// if there are none.
[[nodiscard]] std::string groups_tied_by_drift(const NetworkReadings& readings);

/// Returns true if a station was read twice in one loop.
[[nodiscard]] bool has_repeat(const NetworkReadings& readings);

}  // namespace a351::corrector
