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
    std::vector<record::TxChunk> sent;  ///< In order, for the journal.
    std::size_t bytes_passed_over = 0;  ///< That came, but were no answer.
};

/// Does on the port what the handshake says until it ends, one way or another.
/// @param stop  when it becomes true the run ends with a failure.
[[nodiscard]] HandshakeRun run_handshake(wire::Handshake& handshake, Port& port,
                                         const HostClock& clock, const std::atomic<bool>& stop);

}  // namespace a351::daemon
