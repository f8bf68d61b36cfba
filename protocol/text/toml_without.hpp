#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace a351::text {

/// Returns a TOML document without its comments and without a key of one of its tables, so that it
/// can be shown to others.  A comment may have an old value of the key, so none is kept.
/// @param file  a document that read_toml() accepts.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string toml_without(const std::filesystem::path& file, std::string_view table,
                                       std::string_view key);

}  // namespace a351::text
