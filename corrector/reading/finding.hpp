#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector::reading {

/// A mistake or a fault that was found in a day.
struct Finding {
    std::string kind;    ///< moved_box, bad_reading.
    std::string site;    ///< Site of the stay.
    int occupation = 1;  ///< Number of the stay at this site.
    std::string key;     ///< Key of the stay in the event log; may be empty.
    UtcTime time;        ///< When it happened.
    std::string text;    ///< One sentence.
    /// Amendment that carries out the proposal, TOML.
    std::string amendment;
};

/// Returns an array with one object per finding, for result.json.
[[nodiscard]] nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);

}  // namespace a351::corrector::reading
