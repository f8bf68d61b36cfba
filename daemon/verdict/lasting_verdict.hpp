#pragma once

#include <algorithm>
#include <optional>

#include "daemon/verdict/verdict.hpp"

namespace a351::daemon::verdict {

/// Time that a verdict must last before it is logged.  Reason: each event is synced, and near a
/// limit the verdict may change with each value of the live series.
inline constexpr Nanoseconds kLeastLogged = std::chrono::seconds(5);

/// A verdict that is worth an event.
struct Change {
    State state = State::no_data;
    UtcTime since;

    bool operator==(const Change&) const = default;
};

/// Chooses the verdicts that are worth an event: each that is another one than the last event and
/// has lasted kLeastLogged.  All times are those of the data.
class LastingVerdict {
public:
    /// @param from  no change is earlier than this, because an earlier verdict was not shown
    explicit LastingVerdict(UtcTime from = {}) : from_(from) {}

    /// Takes the verdict on the data up to `time`.
    /// @return the change, once, if it is to be logged
    [[nodiscard]] std::optional<Change> take(const Verdict& verdict, UtcTime time) {
        if (verdict.state == logged_ || time - verdict.since < kLeastLogged) return std::nullopt;
        logged_ = verdict.state;
        return Change{verdict.state, std::max(verdict.since, from_)};
    }

private:
    UtcTime from_;
    std::optional<State> logged_;
};

}  // namespace a351::daemon::verdict
