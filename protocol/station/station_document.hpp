#pragma once
/// @file
/// StationXML as a tree, for the files that read and extend it.
///
/// Other code uses station_xml.hpp, which does not need pugixml.  No function here writes a file.
///
///     auto document = load_station_document(file);
///     ...                                            // change the tree
///     return xml_text(document);

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "protocol/station/station_xml.hpp"

namespace a351::station {

/// Begin of the comment of a channel that names its wire::DeviceProfile; a blank follows the name.
inline constexpr const char* kProfileComment = "device profile ";

/// Returns the document as text in UTF-8, indented by two blanks.  The same tree gives the same
/// bytes.
[[nodiscard]] std::string xml_text(const pugi::xml_document& document);

/// Reads a file and checks its channels, those of ended epochs too.
///
/// The document has at least one station afterwards, and no prefix of a namespace.  Each channel has a response with a unit, and
/// dates that are absent or valid.  The codes and the number of channels are not checked.
/// @return the whole document, elements included that this project does not use.
/// @throws InputError  the file is missing or is not StationXML, or a channel lacks data that
///                     read_station_xml() needs.  The message names the file.
[[nodiscard]] pugi::xml_document load_station_document(const std::filesystem::path& file);

/// Returns the instant in an attribute of a node; std::nullopt if the node does not have it or it
/// is empty.
/// @param file       named in the message of an error; it is not read.
/// @param attribute  "startDate" or "endDate"; its text is RFC 3339, in UTC without a zone.  An
///                   endDate after 2261 means that there is none.
/// @throws InputError  the attribute is not an instant.
[[nodiscard]] std::optional<UtcTime> date_of(const std::filesystem::path& file, pugi::xml_node node,
                                             const char* attribute);

/// Returns true if an epoch is in force at an instant; without one, if the epoch has no end.
/// @param file  named in the message of an error; it is not read.
/// @throws InputError  a date of the channel is not an instant.
[[nodiscard]] bool is_in_force(const std::filesystem::path& file, pugi::xml_node channel,
                               std::optional<UtcTime> at);

}  // namespace a351::station
