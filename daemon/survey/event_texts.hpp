#pragma once
/// @file
/// Texts of the events that the operator's requests become.

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/survey/occupations.hpp"

namespace a351::daemon::survey {

using Minutes = std::chrono::duration<double, std::ratio<60>>;

/// Returns an instant as an operator reads it.
inline std::string shown(UtcTime time) { return to_rfc3339(time, 1); }

inline Outcome refused(text::Message message) {
    return {Outcome::Kind::refused, std::move(message)};
}

inline text::Message no_sample() {
    return text::message("no sample is available yet; see the status");
}

/// Adds a detail unless it is empty.
inline void add(events::Event& event, const std::string& key, std::string_view text) {
    if (!text.empty()) event.details[key] = text;
}

inline void add(events::Event& event, const Remark& remark) {
    add(event, "operator", remark.operator_name);
    add(event, "note", remark.note);
    add(event, "reason", remark.reason);
}

/// Returns the name of a running or finished occupation.
text::Message named(const auto& occupation) {
    return text::message("{} (stay {})", occupation.site, occupation.number);
}

}  // namespace a351::daemon::survey
