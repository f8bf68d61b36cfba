#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace a351::text {

/// Name and content of a file; the name may include folders below the directory.
using NamedText = std::pair<std::string, std::string>;

/// Writes all files into `directory` under temporary names, then renames them.  An error before the
/// first rename leaves every file as it was.  Folders are created when absent.
/// @throws std::system_error  with the path.
void write_together(const std::filesystem::path& directory, const std::vector<NamedText>& files);

}  // namespace a351::text
