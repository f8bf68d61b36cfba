#pragma once
/// @file
/// Functions for the declaration of status fields, see status_fields.hpp.

#include <chrono>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "daemon/page/status_fields.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::page {

/// A value of which the field is left out.
inline nlohmann::json left_out() { return nlohmann::json::value_t::discarded; }

inline nlohmann::json json_of(UtcTime time) { return to_rfc3339(time, 3); }
template <class Value>
nlohmann::json json_of(const Value& value) {
    if constexpr (requires { value.has_value(); })
        return value ? json_of(*value) : nlohmann::json();
    else if constexpr (requires { value.value(); })
        return value.value();
    else if constexpr (requires { value.count(); })
        return std::chrono::duration<double>(value).count();
    else
        return value;
}

/// Returns the function that gives a member of the status, null if it is absent.
template <class Value>
auto of(Value status::Status::*member) {
    return [member](const Moment& now) { return json_of(now.status.*member); };
}

/// Returns the function that gives a value of a part of the status, null without the part.
template <class Part, class Get>
auto of(std::optional<Part> status::Status::*part, Get get) {
    return [part, get](const Moment& now) {
        const auto& present = now.status.*part;
        return present ? json_of(std::invoke(get, *present)) : nlohmann::json();
    };
}

/// Returns the function that gives a value while a condition is met; otherwise the field is left out.
template <class Condition, class Get>
auto only_if(Condition is_met, Get get) {
    return
        [is_met, get](const Moment& now) { return is_met(now) ? json_of(get(now)) : left_out(); };
}

/// Returns the function that gives null for a table of fields that are all left out.
template <class Condition>
auto null_without(Condition is_met) {
    return [is_met](const Moment& now) { return is_met(now) ? left_out() : nlohmann::json(); };
}

/// Returns several lists as one.
inline Fields concatenated(std::initializer_list<Fields> lists) {
    Fields all;
    for (const Fields& one : lists) all.insert(all.end(), one.begin(), one.end());
    return all;
}

}  // namespace a351::daemon::page
