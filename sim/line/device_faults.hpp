#pragma once

#include "sim/device/register_machine.hpp"
#include "sim/line/fault.hpp"

namespace a351::sim {

/// Changes settings of a device and puts it into sampling, as if it had come back with them.  What
/// the host has said so far, its window and half a command, stays.
/// @param now  on the machine's clock.
void change_settings(RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now);

}  // namespace a351::sim
