#pragma once
/// @file
/// The bodies of the requests that change something.  Errors are InputError and name the key.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/occupations.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::page {

/// The body of a POST: a JSON object whose values are texts.  A key that is absent, null or ""
/// counts as not given.
struct Order {
    std::string key;        ///< Key of a stay.
    std::string code;       ///< Code of a contradiction.
    std::string site;       ///< To rename: the correct one; else that of the stay.
    survey::Remark remark;  ///< Keys operator, note and reason.
    std::optional<UtcTime> at, from, to;
    std::optional<int> set_ups;  ///< Planned set-ups of this stay.
    std::optional<int> face;     ///< Face of the set-up that begins, see events::face_of().
};

/// Reads the body of a POST.
/// @param allowed  keys that may be given; others are refused.
/// @throws InputError  not a JSON object, a key that is not allowed, a value that is not a text, or
///                     a time that is not RFC 3339, set_ups that is not a whole number, or a face
///                     that is neither + nor -.
[[nodiscard]] Order parse_order(std::string_view body, const std::vector<std::string>& allowed);

/// Reads the body {"site": text, "latitude_deg": number, "longitude_deg": number}, optionally with
/// altitude_m and gravity_mgal, which may be null.  The values are not checked.
/// @throws InputError  anything else.
[[nodiscard]] text::Site parse_new_site(std::string_view body);

}  // namespace a351::daemon::page
