#pragma once
/// @file
/// The data root, which contains journal/ archive/ metadata/ events/ state/.

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/files/file_layer.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon::store {

/// Thrown if another daemon uses this data root.
class DataRootLocked : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Keeps a data root locked: the folder itself, and `state/lock` for network file systems, which do
/// not lock a folder.  The kernel releases the locks when the process ends.
class DataRootLock {
public:
    /// Creates missing directories and takes the lock.
    /// @throws DataRootLocked     another process has a lock.
    /// @throws std::system_error  the root cannot be used.
    DataRootLock(files::FileLayer& files, const std::filesystem::path& root);
    ~DataRootLock();
    DataRootLock(const DataRootLock&) = delete;
    DataRootLock& operator=(const DataRootLock&) = delete;

private:
    int open(const std::filesystem::path& root, int folder, const std::filesystem::path& name,
             int flags);

    std::vector<int> descriptors_;
};

/// Extends `metadata/station.xml` by the epochs that begin with this description, or creates it.  A
/// file that cannot be used is renamed and replaced by a new one.
/// @return  the trouble with the existing file; std::nullopt if none.
/// @throws std::system_error  it cannot be read or written.
std::optional<std::string> describe_station(files::FileLayer& files,
                                            const std::filesystem::path& root,
                                            const station::Description& description);

}  // namespace a351::daemon::store
