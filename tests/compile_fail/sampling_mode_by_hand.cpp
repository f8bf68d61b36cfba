// Law: a SamplingMode comes only from start_sampling().
#include "protocol/wire/commands.hpp"

a351::wire::CommandSequence stop([[maybe_unused]] a351::wire::ConfigMode config) {
#ifdef A351_LEGAL
    return std::move(config).start_sampling().first.stop();
#else
    return a351::wire::SamplingMode().stop();
#endif
}
