#pragma once

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::daemon {

/// Reads [verdict]: each threshold under its own name; absent ones are taken from `defaults`.
/// @throws InputError  a value out of its range, or an unknown key.
[[nodiscard]] VerdictOptions read_verdict(text::TomlTable table, const VerdictOptions& defaults);

}  // namespace a351::daemon
