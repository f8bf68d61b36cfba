#pragma once

#include "sim/device/register_machine.hpp"
#include "sim/line/fault.hpp"

namespace a351::sim {

/// Changes settings of a device and starts sampling, as if it had restarted with them.  The window
/// that the host selected and a partial command are kept.
/// @param now  time on the machine's clock.
void change_settings(RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now);

}  // namespace a351::sim
