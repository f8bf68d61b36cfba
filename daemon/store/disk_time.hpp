#pragma once

#include <chrono>
#include <functional>

namespace a351::daemon {

/// Real time, by which journal and archive write, sync and try again.
struct DiskTime {
    std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
    /// Between tries when a file could not be written.
    std::chrono::milliseconds retry_interval{10'000};
};

}  // namespace a351::daemon
