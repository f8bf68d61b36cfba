// Law: there is no write command in sampling mode, because the device ignores writes while it
// samples.
#include "protocol/wire/commands.hpp"

a351::wire::CommandSequence change_rate(a351::wire::ConfigMode config) {
#ifdef A351_LEGAL
    return config.write(a351::wire::kSmplCtrl, 0x0600, 0x0F00);
#else
    auto sampling = std::move(config).start_sampling().first;
    return sampling.write(a351::wire::kSmplCtrl, 0x0600, 0x0F00);
#endif
}
