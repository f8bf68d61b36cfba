#pragma once
/// @file
/// The lists of a scenario: sites, occupations, course of the ambient, open lids.

#include "protocol/text/strict_toml.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// Reads [[site]], [[occupation]], [[ambient]] and [[lid_open]].  Each list that is there replaces
/// that of the base as a whole; [[occupation]] does away with the base's other lists but the sites.
/// Precondition: the schedule of `scenario` is read.
/// @throws InputError  what is missing, unknown, out of order or does not fit into the record.
void read_places(text::TomlTable& document, Scenario& scenario);

/// `name`, which goes into CSV cells and TOML strings as it is.
/// @throws InputError  missing, or with a character that would need quoting there.
[[nodiscard]] std::string required_name(text::TomlTable& table);

/// @throws InputError  missing, or not within [low, high]; not an instant.
[[nodiscard]] double required_number(text::TomlTable& table, std::string_view key, double low,
                                     double high);
[[nodiscard]] UtcTime required_instant(text::TomlTable& table, std::string_view key);

}  // namespace a351::sim
