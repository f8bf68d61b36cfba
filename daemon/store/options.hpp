#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/disk_policy.hpp"
#include "daemon/store/journal_keeper.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/archive/recovery.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon::store {

/// Options of a Store.
struct Options {
    std::filesystem::path root;
    /// Station as configured; device and times are added for each session.
    station::Description station = {};
    DiskTime time = {};
    std::uint64_t reserve_bytes = kReserve_bytes;
    std::size_t queue_bytes = ChunkQueue::kCapacityBytes;
    std::size_t waiting_records_bytes = kWaitingRecords_bytes;
    JournalKeeper::Options keeper = {};
    std::chrono::milliseconds commit_patience = kCommitPatience;
    /// Called by another thread when the last run's journal is completely in the archive.
    std::function<void(const archive::RecoveryReport&)> recovered = [](const auto&) {};
    /// Called by another thread, once, before anything is recorded or recovered.  Must not throw.
    std::function<void()> begin = [] {};
    /// Called by another thread when another sensor begins to record, before its first sample, with the
    /// event that is to be noted: Occupations::end_at_exchange().  Must not wait.
    std::function<void(const events::Event&)> other_unit = [](const auto&) {};
    /// Called by another thread for each sample that received its index and time, also those of the
    /// last run's journal.
    std::function<void(const archive::Sample&, UtcTime)> sample = [](const auto&, UtcTime) {};
};

}  // namespace a351::daemon::store
