#pragma once

#include <optional>

#include "corrector/reading/decimated_axes.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/occupation_list.hpp"

namespace a351::corrector::reading {

/// A set-up during which the box was moved.
struct MovedStay {
    /// The part in which it stood, with the note `moved`; the whole with the note `shaken` if it
    /// was never at rest.
    OccupationWindow still;
    Finding finding;  ///< moved_box, early_start, missed_set_up or bad_reading.
};

/// Returns the part of a set-up in which the box stood (protocol/signal/moved_box.hpp), and what
/// happened; std::nullopt if it was not moved, or if its times or its use were amended: then a person
/// has looked at it.
/// @param record, axes  samples of the window.
[[nodiscard]] std::optional<MovedStay> moved_stay(const OccupationWindow& window,
                                                  const OccupationRecord& record,
                                                  const DecimatedAxes& axes);

}  // namespace a351::corrector::reading
