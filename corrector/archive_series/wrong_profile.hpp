#pragma once
/// @file
/// Values that no sensor sends, because they were computed with the profile of another one.
///
///     refuse_wrong_profile(root, wire::profile_option("--profile", "A352AD10"));

#include <filesystem>

#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::corrector::archive_series {

/// Cause and remedy of such values.
inline constexpr const char* kWrongProfile = text::marked(
    "no sensor sends such values: its profile was wrong; find the right one with a351d --config "
    "FILE --identify, and write the archive again with a351-correct retime --profile");

/// Refuses a profile that cannot be that of a recording.
///
/// The journal is read with it in pieces of ten seconds.  The profile is refused if the median piece has
/// a norm, a temperature or a rate of samples that no sensor has (sensor_limits.hpp), or if hardly a
/// sample follows the one before, as with a profile of a higher rate.  A box that is carried, a dead
/// axis or another sensor for less than half of the time changes no median, and lost samples change
/// none.  A journal without a whole piece is not judged.
/// @param root  data root with a journal.
/// @return a warning if a sensor of the journal is of another product than the profile's; empty if not.
///         Two products can have the same scales, so another product alone is not refused.
/// @throws InputError  the profile is refused, with the value, the cause and the remedy; or it lacks a
///                     setting of the journal.
[[nodiscard]] text::Message refuse_wrong_profile(const std::filesystem::path& root,
                                                 const wire::DeviceProfile& profile);

}  // namespace a351::corrector::archive_series
