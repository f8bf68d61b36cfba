#pragma once

#include <filesystem>
#include <vector>

#include "protocol/files/file_layer.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::survey {

/// Appends a site to a list of sites, in one step: readers find the old list or the new one, also
/// after a crash.
///
/// The list is read again before, so that other changes of it are kept.  All bytes of it remain,
/// and its permissions; if its last line has no line end, it gets one.  The row has the columns of
/// the header, and cells of other columns are empty.  If `file` is a link, the list to which it
/// leads is replaced.
/// @param site  altitude and gravity are written if they are known.
/// @return  the new list
/// @throws InputError  the list is not valid, the name is there already or not allowed, or a number
///                     is out of range; nothing was written.
/// @throws std::system_error  the list cannot be written.
[[nodiscard]] std::vector<text::Site> append_site(files::FileLayer& files,
                                                  const std::filesystem::path& file,
                                                  const text::Site& site);

}  // namespace a351::daemon::survey
