#pragma once

#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon::store {

/// Extends `metadata/station.xml` by the epochs that begin with this description, or creates it.  A
/// file that cannot be used is renamed and replaced by a new one.
/// @return  the trouble with the existing file; std::nullopt if none.
/// @throws std::system_error  it cannot be read or written.
std::optional<std::string> describe_station(files::FileLayer& files,
                                            const std::filesystem::path& root,
                                            const station::Description& description);

/// The station metadata of the sessions: noted by the thread that decodes, and written by the thread
/// that writes records, before those of the session.
///
/// Thread-safe.  The lock is never held for disk access.
class StationMetadata {
public:
    /// @param files    must outlive this.
    /// @param station  as configured; device and times are added for each session.
    StationMetadata(files::FileLayer& files, std::filesystem::path root,
                    station::Description station);

    /// Notes the header of a segment, of a new session or of the running one.
    void note(const journal::Header& header);

    /// Describes the sessions that were noted.  Trouble does not delay the records; the next header
    /// tries again.
    void write() noexcept;

    /// Returns the trouble with the newest description; empty if none.
    [[nodiscard]] std::string trouble() const;

private:
    [[nodiscard]] std::string describe(const journal::Header& header) const;

    files::FileLayer& files_;
    std::filesystem::path root_;
    station::Description station_;
    mutable std::mutex mutex_;
    std::deque<journal::Header> noted_;
    std::string trouble_;
};

}  // namespace a351::daemon::store
