#pragma once
/// @file
/// Parts of a record that come from several files or roots, as one.

#include <vector>

#include "corrector/long_record/long_record.hpp"

namespace a351::corrector {

/// All parts in order of time.  A stretch that begins within a bridged gap (SegmentOptions) of the one
/// before it goes on with that: what is missing between them becomes missing samples.  Its samples are
/// counted on from there and keep their times, so that they lie up to half a step beside the first
/// part's clock.
/// @param parts  at least one.
/// @throws InputError  parts overlap, or have another step; names the two.
[[nodiscard]] LongRecord joined_record(std::vector<LongRecord> parts);

}  // namespace a351::corrector
