// Law: start_sampling() takes the ConfigMode away, so that no command can be made while the device
// samples.
#include "protocol/wire/commands.hpp"

a351::wire::CommandSequence start(a351::wire::ConfigMode config) {
#ifdef A351_LEGAL
    return std::move(config).start_sampling().second;
#else
    return config.start_sampling().second;
#endif
}
