#pragma once
/// @file
/// All stations of a day in one linear system, in which any references can be hidden.
///
/// It answers what the instrument measured, as if the references of some stations were not known.
/// Lags and noise are those of a fit, the noise with its expected variances; a change of the lags
/// enters to first order:
///
///     const DayFit fit = fit_day(record, stations).value();
///     const StationSystem system(record, stations, fit, priors);
///     system.difference(3, 5);   // gravity of station 5 minus that of station 3
///     system.correlation();      // of the stations' values, each with its own reference hidden
///
/// The error of an estimate is a sum of independent errors of variance 1: those of the whitened
/// readings and those of the priors.  Two estimates from different sets of references have
/// their errors in common, and so a covariance.  With X the columns of all gravities, held and free,
/// and s = (x'x + 1)^-1 wanted of the columns x that a set of references has:
///
///     covariance of two estimates = s1' (X'X + 1) s2
///
/// So X'X is enough, and columns that every set has may be eliminated from it before.

#include <Eigen/Core>
#include <vector>

#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::whole_day {

/// The gravity of a station.  A column is -1 if there is none.
struct StationGravity {
    double fitted_mgal = 0.0;
    bool is_held = false;
    double u_mgal = 0.0;     ///< Uncertainty of the reference that is held.
    Eigen::Index held = -1;  ///< Column in the fit: of an unknown, or an uncertain reference.
    Eigen::Index own = -1;   ///< Column without prior knowledge; of an unknown the same.
};

/// All stations of a fit.  Constant members may be called from several threads at a time.
class StationSystem {
public:
    /// @param gravities  one per number.
    /// @param products   (n, n) X'X of whitened columns whose priors are independent and of variance 1,
    ///                   those of the gravities included.
    /// @param gradient   (n) products of the columns with the residuals of the fit, minus the fitted
    ///                   coefficients: 0 for columns of the fit.
    StationSystem(std::vector<StationGravity> gravities, Eigen::MatrixXd products,
                  Eigen::VectorXd gradient);

    /// @param record, stations, priors  those of the fit.
    /// @param fit  fit of all stations.
    StationSystem(const reading::DayRecord& record, const std::vector<DayStation>& stations,
                  const DayFit& fit, const DayPriors& priors);

    /// Returns gravity of station `to` minus gravity of `from`, mGal, with the references of both
    /// hidden and all others held.
    ///
    /// Accuracy (station_system_test.cpp): on made-up days of ten stations the value is within
    /// 0.1 mGal, and the standard error within 10 %, of a fit without both references.  On simulated
    /// days differences scatter as stated (tests/bench/differences.py).
    /// @param from, to  two different numbers of DayStation.
    [[nodiscard]] Estimate difference(std::size_t from, std::size_t to) const;

    /// Returns the gravity of a station with its own reference hidden and all others held; if it alone
    /// is held, the reference with its uncertainty.
    [[nodiscard]] Estimate left_out(std::size_t number) const;

    /// Returns the correlation (stations, stations) of the errors of all gravities, each estimated
    /// with its own reference hidden, in order of their numbers.  If only one is held, it stays held;
    /// its row is 0 if it has no uncertainty.
    ///
    /// It is positive semidefinite, because it is that of sums of independent errors.
    [[nodiscard]] Eigen::MatrixXd correlation() const;

private:
    /// A sum of gravities: its value minus that of the fit, and its part of each column.
    struct Combination {
        double value_mgal = 0.0;
        Eigen::VectorXd parts;
    };
    /// Returns the sum of wanted coefficient x its change from the fit, in a system of these columns.
    /// @param wanted  one per column of all; 0 for columns that the system lacks.
    [[nodiscard]] Combination solved(const std::vector<Eigen::Index>& columns,
                                     const Eigen::VectorXd& wanted) const;
    /// Returns the gravity of a station as left_out(), as a combination.
    [[nodiscard]] Combination left_out_combination(std::size_t number) const;
    /// Returns the variance of a combination, mGal^2.
    [[nodiscard]] double variance_mgal2(const Combination& combination) const {
        return combination.parts.dot(information_ * combination.parts);
    }

    std::vector<StationGravity> gravities_;  ///< One per number.
    std::vector<Eigen::Index> common_;       ///< Columns that every system has.
    Eigen::MatrixXd information_;            ///< X'X + 1.
    Eigen::VectorXd gradient_;
};

}  // namespace a351::corrector::whole_day
