#pragma once

#include <cstdint>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon {

/// A sample of the running session and its time.
struct Instant {
    record::SessionId session;
    std::int64_t index = 0;
    UtcTime utc;
};

/// What the survey side asks of the store.  Called from the web thread; the store answers from
/// whatever thread it likes.
class Recorder {
public:
    virtual ~Recorder() = default;

    /// The last sample received; std::nullopt while none has come in this session.
    [[nodiscard]] virtual std::optional<Instant> latest() = 0;

    /// The first sample at or after `utc`; std::nullopt when it lies before the part of the record
    /// that is remembered, or after the last sample.
    [[nodiscard]] virtual std::optional<Instant> at(UtcTime utc) = 0;

    /// Writes the event to journal and event log and syncs both before it returns.
    /// @throws std::system_error  it is not on disk.
    virtual void commit(const record::Event& event) = 0;
};

}  // namespace a351::daemon
