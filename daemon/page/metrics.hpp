#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/page/page_use.hpp"

namespace a351::daemon {

/// Content type of the answer of GET /metrics.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Returns the status for monitoring programs, in Prometheus' text format 0.0.4
/// (https://prometheus.io/docs/instrumenting/exposition_formats/).
/// @param status  the body of GET /api/status; values that are null are left out.
[[nodiscard]] std::string metrics_of(const nlohmann::json& status, const PageUse& use);

}  // namespace a351::daemon
