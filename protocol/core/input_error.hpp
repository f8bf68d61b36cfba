#pragma once

#include <stdexcept>

namespace a351 {

/// Bad input from outside (configuration, CSV, command line).  The message is one line that names
/// file, line, key, value and what is allowed; `main` prints it and ends with status 2.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace a351
