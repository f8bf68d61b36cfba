#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace a351::sim {

/// Returns the bytes that a UART set to `heard_baud` receives when `bytes` are sent without a pause
/// at `sent_baud`, 8N1, with an idle line before and after.  The UART waits for a falling edge and
/// samples the bits in their middle.  Bytes without a stop bit are kept, as in a terminal without
/// PARMRK.  At equal speeds the bytes are unchanged.
[[nodiscard]] std::vector<std::byte> received_at_baud(std::span<const std::byte> bytes,
                                                      int sent_baud, int heard_baud);

}  // namespace a351::sim
