#pragma once
/// @file
/// What the page takes from the gravity so far.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/signal.hpp"

namespace a351::daemon::page {

/// The result of the day so far.
struct SoFar {
    /// For each key of a stay: gravity_mgal and u_mgal, null if not known, and missing_parts, what is
    /// needed before they are known.
    std::map<std::string, nlohmann::json> stays;
    std::vector<survey::Contradiction> contradictions;
};

/// Reads the body of GET /api/survey; what is not as expected is left out.
[[nodiscard]] SoFar read_so_far(std::string_view document);

}  // namespace a351::daemon::page
