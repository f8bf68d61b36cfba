#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon::survey {

/// Least time by which a clock is behind recorded data before it counts as set back.  Reason: above the
/// uncertainty of a locked clock.
inline constexpr Nanoseconds kLeastBack = std::chrono::seconds(5);

/// A sample of the running session and its time.
struct Instant {
    journal::SessionId session;
    std::int64_t index = 0;
    UtcTime utc;
};

/// The requests of the survey side to the store.  They are called from the web thread; the store
/// may answer with any thread.
class Recorder {
public:
    virtual ~Recorder() = default;

    /// Returns the last sample received; std::nullopt if there is none yet.
    [[nodiscard]] virtual std::optional<Instant> latest() = 0;

    /// Returns the first sample at or after `utc`; std::nullopt if `utc` is before the data kept in
    /// memory or after the last sample.
    [[nodiscard]] virtual std::optional<Instant> at(UtcTime utc) = 0;

    /// Returns the length of the signal from this sample to the last one, at the nominal rate.  A
    /// clock that was set meanwhile does not count, nor does the pause between two sessions.  If the
    /// session is no longer remembered, it is the length of all signal that is.
    [[nodiscard]] virtual Nanoseconds signal_since(const journal::SessionId& session,
                                                   std::int64_t index) = 0;

    /// Writes the event to journal and event log and syncs both before it returns.
    /// @throws std::system_error  the event is not on disk.
    virtual void commit(const events::Event& event) = 0;

    /// Writes the event like commit(), after the events before it, and does not wait.  It is lost if
    /// the disk refuses it.
    virtual void note(const events::Event& event) = 0;
};

}  // namespace a351::daemon::survey
