#pragma once
/// @file
/// Events of 2026-03-01 for tests.

#include <map>
#include <string>

#include "protocol/events/event_log.hpp"

namespace a351::events {

inline UtcTime at(const std::string& time) { return *parse_rfc3339(time); }

inline Event event_of(std::string type, const std::string& time_of_day,
                      std::map<std::string, std::string> details = {}) {
    return {std::move(type), at("2026-03-01T" + time_of_day + ":00Z"), std::nullopt, std::nullopt,
            std::move(details)};
}

inline Event start(const std::string& time_of_day, const std::string& site) {
    return event_of("start", time_of_day, {{"site", site}});
}
inline Event stop(const std::string& time_of_day) { return event_of("stop", time_of_day); }

}  // namespace a351::events
