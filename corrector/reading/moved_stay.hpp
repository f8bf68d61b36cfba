#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/occupation_list.hpp"

namespace a351::corrector::reading {

/// A set-up during which the box was moved.
struct MovedStay {
    /// The part in which it stood, with the note `moved` if there is a finding; the whole with the note
    /// `shaken` if it was never at rest.
    OccupationWindow still;
    /// moved_box, early_start, missed_set_up or bad_reading; absent after a change of set-ups.
    std::optional<Finding> finding;
};

/// Returns the part of a set-up in which the box stood (protocol/signal/move_meaning.hpp), and what
/// happened; std::nullopt if it was not moved, or if its times or its use were amended: then a person
/// has looked at it.
/// @param windows  set-ups of the survey, in order of time.
/// @param i        index of the set-up.
/// @param record, axes  its samples.
[[nodiscard]] std::optional<MovedStay> moved_stay(const std::vector<OccupationWindow>& windows,
                                                  std::size_t i, const OccupationRecord& record,
                                                  const DecimatedAxes& axes);

}  // namespace a351::corrector::reading
