#pragma once
/// @file
/// The lists of a scenario: sites, occupations, course of the ambient, open lids.

#include "protocol/text/strict_toml.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim::scenario {

/// Reads [[site]], [[occupation]], [[ambient]] and [[lid_open]].  Each list in the file replaces
/// the whole list of the base; [[occupation]] also removes the base's [[ambient]] and [[lid_open]].
/// Precondition: the schedule of `scenario` has been read.
/// @throws InputError  an entry is missing, unknown, out of order or does not fit into the record.
void read_places(text::TomlTable& document, Scenario& scenario);

/// Returns `name`, which can be written into CSV cells and TOML strings unchanged.
/// @throws InputError  it is missing or has a character that would need quoting there.
[[nodiscard]] std::string required_name(text::TomlTable& table);

/// Returns the value of a required key.
/// @throws InputError  it is missing or not an instant.
[[nodiscard]] UtcTime required_instant(text::TomlTable& table, std::string_view key);

}  // namespace a351::sim::scenario
