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

/// Reads the body of GET /api/survey.
///
/// A contradiction that was read once stays while its stay has a lesser one, under the code that it
/// had: the figures change a little with each sample, and the operator is to answer.  Not thread-safe:
/// the page's thread owns it.
class SoFarReader {
public:
    /// Members that are not as expected are left out.
    [[nodiscard]] SoFar read(std::string_view document);

private:
    std::map<std::string, std::string> said_;  ///< Codes of the contradictions that stay, by stay.
};

}  // namespace a351::daemon::survey
