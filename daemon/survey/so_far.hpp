#pragma once
/// @file
/// What the page takes from the gravity so far.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/signal.hpp"
#include "protocol/core/units.hpp"
#include "protocol/events/event_log.hpp"
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
/// had: the figures change a little with each sample, and the operator is to answer.  Its begin and its
/// end are events, so that a restart changes nothing.  Not thread-safe: the page's thread owns it.
class SoFarReader {
public:
    using Codes = std::map<std::string, std::string>;  ///< Codes of contradictions, by stay.

    /// @param events  the event log so far, in file order.
    /// @param note    writes an event.
    SoFarReader(const std::vector<events::Event>& events,
                std::function<void(const events::Event&)> note);

    /// Members that are not as expected are left out.
    [[nodiscard]] SoFar read(std::string_view document);

private:
    void keep(Codes codes, const std::optional<UtcTime>& data_end);

    std::function<void(const events::Event&)> note_;
    Codes said_;  ///< Those that stay.
};

}  // namespace a351::daemon::survey
