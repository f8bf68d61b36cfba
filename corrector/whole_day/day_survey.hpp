#pragma once
/// @file
/// The surveys of an adjustment: those of the whole-day model, one unit on one day with its record, and
/// those of other models, whose readings have white noise.

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "corrector/adjustment/helmert_block.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_priors.hpp"

namespace a351::corrector::whole_day {

/// The station of a set-up: its gravity is held or unknown.
struct DayStation {
    std::optional<MilliGal> gravity;  ///< Reference that is held; absent: unknown.
    /// Number of the station from 0.  Set-ups of one number share gravity; it is held if
    /// one of them has a reference.
    std::size_t number = 0;
    MilliGal
        u_gravity{};  ///< Standard uncertainty of the reference, 0.001 to 1000; or 0: it is exact.
    /// Number of steps before the set-up: its reading has the offsets of all of them.
    std::size_t steps = 0;

    /// Returns the standard deviation of what is known of its gravity before the readings, mGal; 0: an
    /// exact reference is held.
    [[nodiscard]] double deviation_mgal() const {
        return gravity ? u_gravity.value() : kFreeGravity_mgal;
    }
};

/// One unit on one day.
///
/// Order of the set-ups: they are numbered from 0 in order of time.  The bins are in order of
/// set-up, and in order of time within it; all bins of a set-up are together.  Element s of the
/// stations belongs to set-up s.  Nothing of this is checked: another order gives a wrong
/// covariance of the noise, without an error.
///
/// Begin the temperature two hours or more before the first bin, because tS is 45 min and the lags
/// begin in equilibrium.  Drives between the set-ups belong to it.
struct DaySurvey {
    const reading::DayRecord* record = nullptr;  ///< Finite; each set-up has a bin.  Not owned.
    std::vector<DayStation> stations;            ///< One per set-up, numbered within this survey.
    DayPriors priors = usual_day_priors();       ///< Equal for all surveys of a unit.
    /// Number in the adjustment of each number of `stations`; empty: the same.  A gravity that one
    /// survey holds is held, with the same value, in all surveys that have it.
    std::vector<std::size_t> gravities = {};
    std::size_t unit = 0;  ///< Number of the unit from 0.
    /// Lagged temperature of the record at its bins, which surveys of the same record share; null: the
    /// survey has its own.
    std::shared_ptr<const LaggedMeans> temperature = {};
};

/// A survey with white noise and terms of its own, as it acts on gravities.
struct WhiteSurvey {
    adjustment::HelmertBlock block;
    /// One for each station of the block; the number is that in the adjustment.
    std::vector<DayStation> stations;
};

}  // namespace a351::corrector::whole_day
