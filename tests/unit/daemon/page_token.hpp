#pragma once

#include <string>

namespace a351::daemon {

/// The page's token in tests.
inline const std::string kToken = "0123456789abcdef0123456789abcdef";

}  // namespace a351::daemon
