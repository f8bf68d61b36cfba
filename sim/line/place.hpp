#pragma once
/// @file
/// Checks of the paths that an emulator will write to, before it creates any file or link.

#include <filesystem>
#include <string>

namespace a351::sim::line {

/// Checks that the directory of `path` exists.
/// @param what  noun with article for the message, such as "a link".
/// @return the status of the path itself (a link is not followed); file_type::not_found if nothing
///         is there.
/// @throws InputError  an empty path; its directory does not exist; its status cannot be read.
[[nodiscard]] std::filesystem::file_status require_directory(const std::filesystem::path& path,
                                                             const std::string& what);

/// Checks that a file can be made at `path`, or that the file there can be written.
/// @throws InputError  as require_directory(); the path is a directory or cannot be written.
void require_file_place(const std::filesystem::path& path);

}  // namespace a351::sim::line
