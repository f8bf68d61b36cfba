#pragma once
/// @file
/// Refuses a path that cannot be written, before the work begins.

#include <filesystem>
#include <string_view>

namespace a351::corrector {

/// @throws InputError  the path is a folder or a device, or its folder is a file.
void require_file_option(std::string_view name, const std::filesystem::path& path);

/// The same for a folder, which may exist.
void require_folder_option(std::string_view name, const std::filesystem::path& path);

}  // namespace a351::corrector
