// Law: there is no read command in sampling mode, because the answer would be mixed into the
// frames.
#include "protocol/wire/commands.hpp"

a351::wire::CommandSequence read(a351::wire::ConfigMode config) {
#ifdef A351_LEGAL
    return config.read(a351::wire::kFlag);
#else
    return std::move(config).start_sampling().first.read(a351::wire::kFlag);
#endif
}
