#include "daemon/store/station_metadata.hpp"

#include <fmt/core.h>

#include <exception>
#include <span>
#include <utility>

#include "protocol/archive/time_gate.hpp"
#include "protocol/core/input_error.hpp"

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
    // The times of the first samples precede their header by the filter's delay.
    description.start = header.clock.realtime - description.group_delay;
    description.product_id = header.product_id;
    description.serial_number = header.serial_number;
    description.firmware = header.firmware;
    description.start_up_test = header.start_up_test;
    description.declared_rate_hz = header.declared_rate_hz;
    description.oven_interval = header.oven_interval;
    description.outer_oven_interval = header.outer_oven_interval;
    try {
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
