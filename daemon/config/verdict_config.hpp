#pragma once

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::daemon {

/// [verdict]: every threshold under its own name; `defaults` has those that are absent.
/// @throws InputError  a value out of its range, or an unknown key.
[[nodiscard]] VerdictOptions read_verdict(text::TomlTable table, const VerdictOptions& defaults);

}  // namespace a351::daemon
