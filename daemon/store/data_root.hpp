#pragma once
/// @file
/// The directory of the record: journal/ archive/ metadata/ events/ state/.

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "protocol/files/file_layer.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon {

/// Another daemon works here.
class DataRootLocked : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Holds `state/lock` of a data root; the kernel frees it when the process ends, however it ends.
class DataRootLock {
public:
    /// Creates the directories that are not there.
    /// @throws DataRootLocked     another process holds it.
    /// @throws std::system_error  the root cannot be used.
    DataRootLock(record::FileLayer& files, const std::filesystem::path& root);
    ~DataRootLock();
    DataRootLock(const DataRootLock&) = delete;
    DataRootLock& operator=(const DataRootLock&) = delete;

private:
    int descriptor_ = -1;
};

/// Extends `metadata/station.xml` by the epochs that begin with this description, or writes it.  One
/// that cannot be used is moved aside.
/// @return  what was wrong with it.
/// @throws std::system_error  it cannot be read or written.
std::optional<std::string> describe_station(record::FileLayer& files,
                                            const std::filesystem::path& root,
                                            const record::StationDescription& description);

}  // namespace a351::daemon
