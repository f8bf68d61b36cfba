#pragma once

#include <optional>

#include "daemon/verdict/verdict.hpp"

namespace a351::daemon::verdict {

/// Time that a verdict must last before it is logged.  Reason: each event is synced, and near a
/// limit the verdict may change every second.
inline constexpr Nanoseconds kLeastLogged = std::chrono::seconds(5);

/// Chooses the verdicts that are worth an event: each that is another one than the last event and
/// has lasted kLeastLogged.
class LastingVerdict {
public:
    /// Takes the verdict at this time.
    /// @return true once for each that is to be logged, from its begin `since` on.
    [[nodiscard]] bool is_due(const Verdict& verdict, UtcTime now) {
        if (verdict.since == UtcTime{} || verdict.state == logged_) return false;
        if (now - verdict.since < kLeastLogged) return false;
        logged_ = verdict.state;
        return true;
    }

private:
    std::optional<State> logged_;
};

}  // namespace a351::daemon::verdict
