#pragma once
/// @file
/// Refuses, before the work is done, a path at which nothing can be written afterwards.

#include <filesystem>
#include <string_view>

namespace a351::corrector {

/// @throws InputError  a folder or a device stands there, or a file in the place of its folder.
void require_file_option(std::string_view name, const std::filesystem::path& path);

/// The same for a folder, which may exist.
void require_folder_option(std::string_view name, const std::filesystem::path& path);

}  // namespace a351::corrector
