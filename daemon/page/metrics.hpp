#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

namespace a351::daemon::page {

/// Counters of the page's thread.
struct PageUse {
    std::size_t connections = 0;         ///< Connections open now, including live streams.
    std::size_t streams = 0;             ///< Live streams open now.
    std::uint64_t messages_dropped = 0;  ///< Messages not sent to viewers that read too slowly.
    std::uint64_t failures = 0;          ///< Exceptions of a source.
};

/// Counts one connection or stream as open as long as the object exists.
class Seat {
public:
    explicit Seat(std::size_t& taken) noexcept : taken_(&taken) { ++taken; }
    Seat(Seat&& other) noexcept : taken_(std::exchange(other.taken_, nullptr)) {}
    ~Seat() {
        if (taken_) --*taken_;
    }

private:
    std::size_t* taken_;
};

/// Content type of the answer of GET /metrics.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Returns the status for monitoring programs, in Prometheus' text format 0.0.4
/// (https://prometheus.io/docs/instrumenting/exposition_formats/).
/// @param status  the body of GET /api/status; values that are null are left out.
[[nodiscard]] std::string metrics_of(const nlohmann::json& status, const PageUse& use);

}  // namespace a351::daemon::page
