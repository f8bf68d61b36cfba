#pragma once
/// @file
/// The StationXML of a data root again, for a journal that is read with another profile.

#include <filesystem>

#include "protocol/files/file_layer.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::station {

/// Writes `metadata/station.xml` of a re-timed data root: the one that the daemon would have written
/// with `profile`.  Sensor, settings and times come from the headers of the journal; position and
/// ovens from the present file, at the same instants.  Other files of the folder are copied.
/// Nothing is written if `from` has no such file.
///
///     archive::retime(files, root, out, &profile, [&](const auto& from, const auto& to) {
///         describe_again(files, from, to, profile);
///     });
///
/// @param from  data root with the folders journal and metadata.
/// @param to    new data root; it has no folder metadata.
/// @throws InputError         the present file is not StationXML, or as archive::recorded_with().
/// @throws std::system_error  a file cannot be read or written.
void describe_again(files::FileLayer& files, const std::filesystem::path& from,
                    const std::filesystem::path& to, const wire::DeviceProfile& profile);

}  // namespace a351::station
