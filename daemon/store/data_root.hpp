#pragma once
/// @file
/// The directory of the record: journal/ archive/ metadata/ events/ state/.

#include <filesystem>
#include <stdexcept>

#include "protocol/record/file_layer.hpp"
#include "protocol/record/station_xml.hpp"

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

/// Replaces `metadata/station.xml` unless it says the same already, instants apart: the epoch goes
/// on while settings and device stay.
void describe_station(record::FileLayer& files, const std::filesystem::path& root,
                      const record::StationDescription& description);

}  // namespace a351::daemon
