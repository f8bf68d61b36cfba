#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/occupations.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

/// The body of a POST: a JSON object whose values are texts.  A key that is absent, null or ""
/// counts as not given.
struct Order {
    std::string site;
    Remark remark;  ///< Keys operator and note.
    std::optional<UtcTime> at;
};

/// Reads the body of a POST.
/// @param allowed  keys that may be given; others are refused.
/// @throws InputError  not a JSON object, a key that is not allowed, a value that is not a text, or
///                     an `at` that is not RFC 3339; names the key.
[[nodiscard]] Order parse_order(std::string_view body, const std::vector<std::string>& allowed);

/// Reads the body {"target_mgal": number}.
/// @throws InputError  anything else.
[[nodiscard]] MilliGal parse_target(std::string_view body);

}  // namespace a351::daemon
