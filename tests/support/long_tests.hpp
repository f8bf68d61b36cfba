#pragma once

#include <cstdlib>
#include <cstring>

namespace a351::test {

/// Returns true in `tests/run --long`.
inline bool is_long() {
    const char* const value = std::getenv("A351_LONG");
    return value != nullptr && std::strcmp(value, "1") == 0;
}

}  // namespace a351::test
