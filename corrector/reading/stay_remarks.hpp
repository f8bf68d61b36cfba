#pragma once

#include <optional>
#include <vector>

#include "corrector/reading/finding.hpp"
#include "corrector/reading/occupation_list.hpp"
#include "protocol/archive/archive_reader.hpp"

namespace a351::corrector::reading {

/// Returns what is unusual about the stays of a day and the times of their record, without use of
/// gravity: no_stop, short_stay and clock, in this order.
///
/// - no_stop: a stay without a stop in which no move of the box was found.
/// - short_stay: all set-ups of a stay together are shorter than half the day's median, and than 6
///   min.  A stay that still runs, was excluded or was divided by an amendment is not compared.
/// - clock: most records of a set-up have a time that is uncertain by more than 1 s; or times go back
///   by 1 s or more.
///   A step forward looks like missing samples, and is not named.
/// @param windows  set-ups with a reading, as they are averaged: cut where the box was moved.
/// @param axis     samples of one axis.
[[nodiscard]] std::vector<Finding> stay_remarks(const std::vector<OccupationWindow>& windows,
                                                const archive::ChannelData& axis);

/// Returns the remark clock if more than half of the set-ups have no samples: either the sensor was
/// not recorded, or the times of the list are wrong, as those of another zone are.
[[nodiscard]] std::optional<Finding> mostly_without_samples(std::size_t without_samples,
                                                            std::size_t set_ups);

/// Returns the finding turned if a set-up is in another face than entered or planned.  It does not change
/// the reading: the data decide.
[[nodiscard]] std::optional<Finding> other_face(const OccupationWindow& window, int face);

}  // namespace a351::corrector::reading
