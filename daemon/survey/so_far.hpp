#pragma once
/// @file
/// What the page takes from the gravity so far.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/signal.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::survey {

/// The gravity of a stay so far.
struct StayGravity {
    std::optional<MilliGal> gravity;
    std::optional<MilliGal> u;  ///< Standard uncertainty; of the running stay by the evening.
    text::Message missing;      ///< What is needed before they are known; empty if they are.
};

/// The result of the day so far.
struct SoFar {
    std::map<std::string, StayGravity> stays;  ///< Each with its key.
    std::vector<Contradiction> contradictions;
};

/// Reads the body of GET /api/survey; members that are not as expected are left out.
[[nodiscard]] SoFar read_so_far(std::string_view document);

}  // namespace a351::daemon::survey
