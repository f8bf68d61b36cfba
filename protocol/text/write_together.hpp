#pragma once
/// @file
/// A set of result files that belong together, so that an error does not leave half of a new set.
///
/// Use it for texts that are in memory.  Use NewFile of new_file.hpp for a file that is written
/// piece by piece.
///
///     write_together("result", {{"stations.csv", stations}, {"figures/day.svg", figure}});

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace a351::text {

/// Name and content of a file; the name may include folders below the directory.
using NamedText = std::pair<std::string, std::string>;

/// Writes all files into `directory` under temporary names, then renames them.  An error before the
/// first rename leaves every file as it was.  Folders are created when absent.
///
/// Files of the same names are replaced; other files of the directory remain.  An error of a later
/// rename, which is rare, leaves some files new and some old.  Created folders remain after an
/// error.  Nothing is synced.
/// @param directory  not empty; "." is the working directory.
/// @param files      names relative to `directory`, each of them once; not checked.  An empty list
///                   does nothing.
/// @throws std::system_error  with the path.
void write_together(const std::filesystem::path& directory, const std::vector<NamedText>& files);

}  // namespace a351::text
