#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace a351::sim {

/// What a UART set to `heard_baud` makes of bytes sent in one go at `sent_baud`, 8N1, the line idle
/// before and after.  It looks for a falling edge, samples ten bits in their middle and takes the
/// eight between; a missing stop bit is not held against them, as in a terminal without PARMRK.
/// Equal speeds give the bytes themselves.
[[nodiscard]] std::vector<std::byte> as_heard(std::span<const std::byte> bytes, int sent_baud,
                                              int heard_baud);

}  // namespace a351::sim
