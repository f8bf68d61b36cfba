#pragma once

#include "sim/device/register_machine.hpp"
#include "sim/line/fault.hpp"

namespace a351::sim {

/// Writes other settings into a device and puts it into sampling, as if it had come back with them.
/// @param now  on the machine's clock.
void change_settings(RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now);

/// Reads DIAG_STAT, which clears it; nobody hears the answer.
void clear_diagnostics(RegisterMachine& machine, Nanoseconds now);

}  // namespace a351::sim
