#pragma once

#include "protocol/text/message.hpp"

namespace a351::daemon::believable {

/// Return the end of a trouble: what the operator should do against a wrong profile, and what if
/// the first remedy does not help.
[[nodiscard]] inline text::Message identify() {
    return text::message(
        "; check sensor.profile: stop the recorder and run a351d --config FILE --identify");
}
[[nodiscard]] inline text::Message or_identify() {
    return text::message(
        "; if this does not help, check sensor.profile: stop the recorder and run a351d "
        "--config FILE --identify");
}

}  // namespace a351::daemon::believable
