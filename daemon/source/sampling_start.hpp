#pragma once
/// @file
/// The two ways to a sampling sensor on a port that is open: a known stream that continues is
/// adopted, any other sensor is configured.

#include <atomic>
#include <cstddef>
#include <variant>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/port.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/journal/stream_end.hpp"
#include "protocol/wire/handshake.hpp"

namespace a351::daemon::source {

/// The result of one read of the port.
struct Read {
    RawTime time;
    std::vector<std::byte> bytes;
};

struct Listening {
    enum class Outcome {
        continues,  ///< The known stream continues: the sensor must not be touched.
        not_known,  ///< Silence or any other bytes: the sensor is stopped and configured.
        port_gone,
    };
    Outcome outcome = Outcome::not_known;
    std::vector<Read> reads;  ///< Everything received, in order.
};

/// Listens on a port that was just opened or has just become silent.
///
/// The stream counts as known when ten consecutive frames keep the counter step of its rate.  The
/// counter of the first or the last of them must also have the value that timing::SampleIndex
/// expects from `known`.  The stream is not known in these cases:
///
/// - ten frames in step have another counter;
/// - a silence of half a second or 20 frame periods, whichever is longer;
/// - some seconds of bytes without ten frames in step.
///
/// A device that restarted meanwhile can be mistaken for the known stream, if its new counter is by
/// chance within a second of the expected one, or continues the old one.  The frequency is that of
/// timing::SampleIndex, and somewhat higher here, because two frames are compared.
/// @param heard  reads of the port that the caller has made already, in order.
/// @param stop   listening ends when it becomes true.
[[nodiscard]] Listening listen_for(const journal::StreamEnd& known, std::vector<Read> heard,
                                   Port& port, const HostClock& clock,
                                   const std::atomic<bool>& stop);

struct Probe {
    enum class Outcome {
        silent,   ///< No byte came.
        stopped,  ///< The sensor does not sample: it can be configured.
        heard,    ///< Other bytes came, as when a plug is back: a stream may continue.
        port_gone,
    };
    Outcome outcome = Outcome::silent;
    std::vector<Read> reads;  ///< The bytes heard.
};

/// Asks a silent sensor for its mode.  A sensor that samples is not disturbed by the question.
/// @param stop  it ends when it becomes true.
[[nodiscard]] Probe probe_silent_line(Port& port, const HostClock& clock,
                                      const std::atomic<bool>& stop);

struct PortGone {};

struct HandshakeRun {
    std::variant<wire::DeviceIdentity, wire::HandshakeFailure, PortGone> outcome;
    std::vector<journal::TxChunk> sent;  ///< Commands in order, for the journal.
    std::size_t bytes_skipped = 0;       ///< Bytes received that were no answer.
};

/// Carries out the steps of the handshake on the port until it succeeds or fails.
/// @param stop  the run ends with a failure when it becomes true.
[[nodiscard]] HandshakeRun run_handshake(wire::Handshake& handshake, Port& port,
                                         const HostClock& clock, const std::atomic<bool>& stop);

}  // namespace a351::daemon::source
