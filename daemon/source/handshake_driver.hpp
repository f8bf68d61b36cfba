#pragma once

#include <atomic>
#include <string>
#include <variant>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/port.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/wire/handshake.hpp"

namespace a351::daemon {

struct PortGone {};

struct HandshakeRun {
    std::variant<wire::DeviceIdentity, wire::HandshakeFailure, PortGone> outcome;
    std::vector<record::TxChunk> sent;  ///< Commands in order, for the journal.
    std::size_t bytes_skipped = 0;      ///< Bytes received that were no answer.
};

/// Carries out the steps of the handshake on the port until it succeeds or fails.
/// @param stop  the run ends with a failure when it becomes true.
[[nodiscard]] HandshakeRun run_handshake(wire::Handshake& handshake, Port& port,
                                         const HostClock& clock, const std::atomic<bool>& stop);

}  // namespace a351::daemon
