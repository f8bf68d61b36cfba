#pragma once
/// @file
/// The gravity of the stations of a survey, and their differences.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "corrector/whole_day/day_fit.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::model {

/// Factor of a coverage of about 95 % where the standard deviations do not come from the scatter of
/// few values.
inline constexpr double kCoverageFactor = 2.0;

/// Errors that a station of one day has in common with stations of other days, as only `day` knows
/// them.
struct SharedErrors {
    /// Those of the unit (whole_day::GravityEstimate::shared_mgal).
    std::vector<double> unit_mgal;  ///< Empty: none.
    bool is_calibrated = false;     ///< The unit's errors are those of its calibration.
    /// Those of the uncertain references that are held, by site.
    std::map<std::string, double> references_mgal;
};

/// Gravity of a station compared with that of the normal Earth.
struct Anomalies {
    MilliGal normal_gravity;  ///< Gravity of GRS80 on the ellipsoid.
    MilliGal free_air;        ///< gravity - normal gravity at the altitude.
    MilliGal bouguer;         ///< free_air - attraction of a plate up to the altitude.
};

/// The value of a station.
///
/// For a station with a reference in the fit, `gravity` is in sample: the fit has seen the
/// reference.  `left_out` has not.
struct StationValue {
    std::string site;              ///< Name of the station.
    std::size_t row_count = 0;     ///< Number of rows averaged; `network`: readings adjusted.
    bool is_flagged_only = false;  ///< True: no row is unflagged; the flagged are averaged.
    MilliGal gravity;              ///< Mean of its corrected values; `network`: adjusted value.
    /// Uncertainty sqrt(s^2 / n + variance of the fit); `network`: a priori; `day`: as if the
    /// reference of the station were unknown.
    std::optional<MilliGal> u_gravity;
    std::optional<MilliGal> u_a_posteriori;  ///< `network` only: s0 times u_gravity.
    std::optional<MilliGal> reference;       ///< Known gravity.
    std::optional<MilliGal> residual;        ///< gravity - reference.
    /// Sum of 1 - leverage over its rows in the fit; `network`: and the redundancy of its datum.
    /// Absent without a row in the fit, and for `day`.
    std::optional<double> redundancy;
    /// Value with the station's own reference hidden, and its standard uncertainty.  A station
    /// without a reference in the fit has gravity and its uncertainty.  Absent for the other stations
    /// of `paper`, and for a station that alone is held.
    std::optional<MilliGal> left_out, u_left_out;
    /// Effective degrees of freedom of u_gravity, and the factor of a coverage of 95 %.  Absent
    /// without u_gravity.  `network`: degrees of freedom of the adjustment, and 2, because u is a
    /// priori; absent if the global test fails.
    std::optional<double> dof, coverage_factor;
    /// Contributions to u_gravity, mGal, in the order of whole_day::ErrorSource; the sum of their squares
    /// is u^2.  `day` only.
    std::optional<std::array<double, whole_day::kErrorSources>> parts_mgal;
    /// Errors of left_out; for the only station that is held, those of its reference.  `day` only.
    std::optional<SharedErrors> shared;
    /// Present if they are asked for, and latitude and altitude are known.
    std::optional<Anomalies> anomalies;
};

/// Gravity of station `to` minus gravity of station `from`.
///
/// `day` and the linear models hide the references of both; `network` adjusts with all of them.
struct StationDifference {
    std::string from, to;
    MilliGal difference;
    MilliGal u;                         ///< Standard uncertainty.
    std::optional<MilliGal> reference;  ///< Difference of the references, if both have one.
};

/// Returns the difference of two stations, with that of their references if both have one.
[[nodiscard]] inline StationDifference difference_of(const StationValue& from,
                                                     const StationValue& to, MilliGal difference,
                                                     MilliGal u) {
    StationDifference result{from.site, to.site, difference, u, std::nullopt};
    if (from.reference && to.reference) result.reference = *to.reference - *from.reference;
    return result;
}

/// Covariance of stations' values.
struct StationCovariance {
    std::vector<std::string> sites;
    /// (sites, sites) Of StationValue::left_out for `day`, else of StationValue::gravity.
    Eigen::MatrixXd mgal2;
};

}  // namespace a351::corrector::model
