#pragma once
/// @file
/// Whether something can be put at a path, asked before anything is.

#include <filesystem>
#include <string>

namespace a351::sim {

/// @param what  that is to be put there, with its article: "a link".
/// @return what stands there now, links not followed; file_type::not_found if nothing.
/// @throws InputError  no path; its directory does not exist; it cannot be looked at.
[[nodiscard]] std::filesystem::file_status require_directory(const std::filesystem::path& path,
                                                             const std::string& what);

/// A file may be made there, or the one that is there be written.
/// @throws InputError  as require_directory; it is a directory; it may not be written.
void require_file_place(const std::filesystem::path& path);

}  // namespace a351::sim
