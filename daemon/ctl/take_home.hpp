#pragma once

#include <filesystem>
#include <string>

#include "daemon/ctl/client.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon::ctl {

/// Saves the survey day as one file, reads it back from the disk and compares it with its checksums.
///
/// The file has its name only when it is complete and checked; otherwise nothing of it is left.
/// Every few megabytes are synced: a slow memory stick then takes no memory from the recorder, and
/// its end shows in time.
/// @param out  the file, or a folder, in which it gets the name that the daemon proposes.
/// @return     one line for the operator.
/// @throws NoDaemon, std::runtime_error  with a sentence.
[[nodiscard]] std::string take_home(const Client& client, files::FileLayer& files,
                                    const std::filesystem::path& out);

}  // namespace a351::daemon::ctl
