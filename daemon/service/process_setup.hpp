#pragma once
/// @file
/// The process of a service: standard streams and signals, set up before any thread starts.

#include <csignal>

namespace a351::daemon::service {

/// Opens standard streams that the caller closed, so that the log is not written to a data file.
void open_standard_streams();

/// Blocks SIGINT, SIGTERM and SIGHUP in this thread and all threads that it starts, and ignores
/// SIGPIPE, because a closed log pipe must not end the service.
/// @return the blocked signals, to wait for with sigtimedwait(2).
[[nodiscard]] sigset_t block_signals();

}  // namespace a351::daemon::service
