#pragma once
/// @file
/// StationXML as a tree, for the files that read and extend it.

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "protocol/station/station_xml.hpp"

namespace a351::record {

/// Returns the document as text, indented by two blanks.
[[nodiscard]] std::string xml_text(const pugi::xml_document& document);

/// Reads a file and checks its channels.
/// @throws InputError  the file is missing or is not StationXML, or a channel lacks data that
///                     read_station_xml() needs.
[[nodiscard]] pugi::xml_document load_station_document(const std::filesystem::path& file);

/// Returns the instant in an attribute of a node; std::nullopt if the node does not have it.
/// @throws InputError  the attribute is not an instant.
[[nodiscard]] std::optional<UtcTime> date_of(const std::filesystem::path& file, pugi::xml_node node,
                                             const char* attribute);

}  // namespace a351::record
