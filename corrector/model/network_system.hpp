#pragma once
/// @file
/// The linear system of a network: stations, terms of the instrument, and rows.
///
/// It is a part of adjust_network(), which solves the system.  The order of calls matters:
///
///     const NetworkReadings readings = find_stations(rows, in_use, datum);
///     NetworkAdjustment network;
///     network.stations = readings.stations;
///     set_terms(network, rows, in_use, priors, options);
///     const NetworkSystem system = build_system(network, rows, in_use, readings, priors, options);
///
/// Unknowns are the stations in the order of `stations`, then the terms.  All functions must get
/// the same rows and the same `in_use`.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "corrector/model/network.hpp"

namespace a351::corrector::model {

/// Returns the standard deviation of a reading, mGal: that of the priors and that of its own average.
[[nodiscard]] double sd_mgal_of(const reading::SurveyRow& row, const Priors& priors);

/// The readings of a network: station and loop of each.
struct NetworkReadings {
    std::vector<std::string> stations;    ///< (s) Names of the stations of the network.
    std::vector<bool> is_held;            ///< (s) True for a datum.
    std::vector<std::size_t> station_of;  ///< Number of the station of each reading, by time.
    /// Number of the loop of each reading, from 0; loops without a reading in use are not counted.
    std::vector<std::size_t> loop_of;
    std::vector<MilliGal> references;  ///< (s) Known gravity; 0 for an unknown station.
    std::vector<std::optional<MilliGal>> u_references;  ///< (s) Their own uncertainties, if given.
};

/// Returns stations, loops and references of the readings in use.
///
/// Stations are in the order of their first reading in use, which also gives the reference.  A
/// station is held if it has a reference and `datum` is empty or contains its name.  Nothing is
/// refused here.
/// @param rows, in_use, datum  as adjust_network().
[[nodiscard]] NetworkReadings find_stations(const std::vector<reading::SurveyRow>& rows,
                                            const std::vector<bool>& in_use,
                                            const std::vector<std::string>& datum);

/// Sets `terms`, `term_columns` and `is_tied` of a network.  Several loops of gravimeters are listed in
/// a remark.
///
/// Times count from the first row of each loop, less kReferenceTime_h, in h; temperatures from
/// kReferenceTemperature, in degC.  A temperature that does not vary between the rows in use and
/// has no prior is left out, with a remark.  The rate takes part only with a prior.
///
/// The terms are, for each loop: constant, time, time^2, time^3, up to the degree; then temperature and
/// rate, which all loops have in common; then each step that has readings in use of one loop before
/// and after it; then the scale of each instrument, whose column is 0 until set_scale_columns().
/// Rows of a loop without a reading in use have zeros.
/// @param rows, in_use, priors, options  as adjust_network().
void set_terms(NetworkAdjustment& network, const std::vector<reading::SurveyRow>& rows,
               const std::vector<bool>& in_use, const Priors& priors,
               const NetworkOptions& options);

/// Linearises the scales about the unknowns of a solved network: their columns become the gravity of
/// the row's station minus the origin.  At a station outside the network it is that of the reading.
/// @param rows  as adjust_network().
void set_scale_columns(NetworkAdjustment& network, const std::vector<reading::SurveyRow>& rows);

/// The unweighted system A x = y.  Labels and standard deviations of its rows:
/// NetworkAdjustment::rows.  A row is weighted by 1 / sd^2.
struct NetworkSystem {
    Eigen::MatrixXd a;  ///< (rows, stations + terms)
    Eigen::VectorXd y;  ///< (rows) Right sides, in the unit of each row.
};

/// Returns the rows of readings in use, datum and priors, in this order.  Also sets `origin`,
/// `rows` and their counts in `network`, which replace those of an earlier round; the origin is the
/// reference of the first station held.
///
/// The origin is subtracted from readings and references, so that y keeps its last digits.  The
/// same prior on a drift applies to each loop, as a row for each.
/// @param network   with stations and terms set; at least one station is held.
/// @param readings  find_stations() of the same rows.
/// @param rows, in_use, priors, options  as adjust_network().
[[nodiscard]] NetworkSystem build_system(NetworkAdjustment& network,
                                         const std::vector<reading::SurveyRow>& rows,
                                         const std::vector<bool>& in_use,
                                         const NetworkReadings& readings, const Priors& priors,
                                         const NetworkOptions& options);

}  // namespace a351::corrector::model
