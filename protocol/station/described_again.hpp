#pragma once
/// @file
/// The StationXML of a re-timed data root: its epochs have the times of the samples.

#include <filesystem>
#include <vector>

#include "protocol/archive/retime.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::station {

/// Writes `metadata/station.xml` of a re-timed data root: the one that the daemon would have written
/// with the right times and, if it was re-timed with a profile, with that profile.  Sensor and settings
/// come from the headers of the journal, the begin of an epoch from its first sample; position and
/// ovens from the present file.  Other files of the folder are copied.
/// Nothing is written if `from` has no such file.  If no sample has a time, the file is copied.
///
///     archive::retime(files, root, out, profile, [&](const auto&... args) {
///         describe_again(files, args...);
///     });
///
/// @param from  data root with the folder metadata.
/// @param to    new data root; it has no folder metadata.
/// @param segments  of the journal, in order.
/// @throws InputError         the present file is not StationXML.
/// @throws std::system_error  a file cannot be read or written.
void describe_again(files::FileLayer& files, const std::filesystem::path& from,
                    const std::filesystem::path& to,
                    const std::vector<archive::RetimedSegment>& segments);

}  // namespace a351::station
