#pragma once

#include <chrono>
#include <functional>

namespace a351::daemon {

/// The real time that journal and archive use for writing, syncing and trying again.
struct DiskTime {
    std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
    /// Time between tries after a file could not be written.
    std::chrono::milliseconds retry_interval{10'000};
};

}  // namespace a351::daemon
