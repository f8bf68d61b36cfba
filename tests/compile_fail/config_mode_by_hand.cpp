// Law: a ConfigMode can be made only from the MODE_CTRL value that the device sent.
#include "protocol/wire/commands.hpp"

a351::wire::CommandSequence read_flag() {
#ifdef A351_LEGAL
    const auto config = a351::wire::ConfigMode::from_mode_ctrl(0x0400).value();
#else
    const auto config = a351::wire::ConfigMode();
#endif
    return config.read(a351::wire::kFlag);
}
