#pragma once
/// @file
/// StationXML as a tree, for the files that read and extend it.

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "protocol/station/station_xml.hpp"

namespace a351::record {

[[nodiscard]] std::string xml_text(const pugi::xml_document& document);

/// @throws InputError  the file is missing, is no StationXML, or a channel lacks what
///                     read_station_xml() needs.
[[nodiscard]] pugi::xml_document load_station_document(const std::filesystem::path& file);

/// Of a node's attribute; std::nullopt without it.
/// @throws InputError  it is no instant.
[[nodiscard]] std::optional<UtcTime> date_of(const std::filesystem::path& file, pugi::xml_node node,
                                             const char* attribute);

}  // namespace a351::record
