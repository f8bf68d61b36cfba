#pragma once
/// @file
/// One record from parts in several files or data roots.
///
/// A logger may begin a new file at midnight, or a data root may be replaced.  Without joining the
/// night would be two segments, each with its own ends.
///
///     std::vector<LongRecord> parts = read_records(files, window);
///     const LongRecord record = joined_record(std::move(parts));

#include <vector>

#include "corrector/long_record/long_record.hpp"

namespace a351::corrector::long_record {

/// Joins parts in order of time.
///
/// If a stretch of another part begins within a gap that is bridged (kLongestBridge), both become
/// one stretch with missing samples between them.
/// Serial number, columns and removal of the tide must be the same.  The samples keep their own
/// times, so that they are up to half a step off the clock of the first part.
///
/// Otherwise the stretches remain apart.  If the sensor changes between parts, there is a warning,
/// and the later stretch has the change in `begins_with`.
///
/// - `is_tide_removed` is true only if it is for every part.
/// - `step_s`, `raw_rate_hz` and the noise by the data sheet are those of the first part in the list.
/// - `inputs` and `warnings` are those of all parts, in the order of the list.
/// @param parts  at least one, in any order; a single part is returned with its stretches in order.
/// @throws InputError  if parts overlap or have different steps; names both.  Steps are the same if
///                     they agree within 0.1 %.  Stretches of one part must not overlap either, as
///                     they do after the host's clock was set back.
[[nodiscard]] LongRecord joined_record(std::vector<LongRecord> parts);

}  // namespace a351::corrector::long_record
