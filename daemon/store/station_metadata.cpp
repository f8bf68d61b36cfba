#include "daemon/store/station_metadata.hpp"

#include <fmt/core.h>

#include <exception>
#include <span>
#include <utility>

#include "protocol/archive/time_gate.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/station/session_description.hpp"

namespace a351::daemon::store {

std::optional<std::string> describe_station(files::FileLayer& files,
                                            const std::filesystem::path& root,
                                            const station::Description& description) {
    const std::filesystem::path file = root / "metadata" / "station.xml";
    std::optional<std::string> xml, trouble;
    try {
        xml = std::filesystem::exists(file) ? station::extend_station_xml(file, description)
                                            : station::to_station_xml(description);
    } catch (const InputError& damage) {
        std::filesystem::path aside = file;
        aside += ".damaged";
        for (int n = 2; std::filesystem::exists(aside); ++n)
            aside = fmt::format("{}.damaged.{}", file.string(), n);
        files.rename(file, aside);
        trouble = fmt::format(
            "{}; the file is kept as {}, and a new one without its earlier epochs was written",
            damage.what(), aside.filename().string());
        xml = station::to_station_xml(description);
    }
    if (xml) files::replace_file(files, file, std::as_bytes(std::span(*xml)));
    return trouble;
}

StationMetadata::StationMetadata(files::FileLayer& files, std::filesystem::path root,
                                 station::Description station)
    : files_(files), root_(std::move(root)), station_(std::move(station)) {}

void StationMetadata::note(const journal::Header& header) {
    const std::lock_guard lock(mutex_);
    // The first header of a session has the time of its start.
    if (noted_.empty() || noted_.back().session != header.session) noted_.push_back(header);
}

void StationMetadata::write() noexcept {
    std::unique_lock lock(mutex_);
    while (!noted_.empty()) {
        const journal::Header header = noted_.front();
        lock.unlock();
        auto trouble = describe(header);
        lock.lock();
        trouble_ = std::move(trouble);
        noted_.pop_front();
    }
}

/// @return the trouble; empty if none.
std::string StationMetadata::describe(const journal::Header& header) const {
    // Without a host clock the start of the epoch is not known.
    if (header.clock.realtime < archive::TimeGate::kEarliest) return {};
    station::Description description = station_;
    try {
        station::describe_session(description, header);
        return describe_station(files_, root_, description).value_or("");
    } catch (const std::exception& error) {
        return error.what();
    }
}

std::string StationMetadata::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

}  // namespace a351::daemon::store
