#pragma once
/// @file
/// One record from parts in several files or data roots.

#include <vector>

#include "corrector/long_record/long_record.hpp"

namespace a351::corrector {

/// Joins parts in order of time.
///
/// If a stretch of another part begins within a gap that is bridged (kLongestBridge), both become
/// one stretch with missing samples between them.
/// Serial number, columns and removal of the tide must be the same.  The samples keep their own
/// times, so that they are up to half a step off the clock of the first part.
/// @param parts  at least one.
/// @throws InputError  if parts overlap or have different steps; names both.
[[nodiscard]] LongRecord joined_record(std::vector<LongRecord> parts);

}  // namespace a351::corrector
