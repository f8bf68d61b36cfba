#pragma once
/// @file
/// The data root, which contains journal/ archive/ metadata/ events/ state/.

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "protocol/files/file_layer.hpp"

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

    /// Returns false if the path leads to another folder than the locked one, or to none.
    [[nodiscard]] bool is_in_place() const noexcept;

private:
    int open(const std::filesystem::path& root, int folder, const std::filesystem::path& name,
             int flags);

    std::filesystem::path root_;
    std::vector<int> descriptors_;  ///< The first is that of the root.
};

}  // namespace a351::daemon::store
