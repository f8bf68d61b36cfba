#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace a351 {

/// Error in an input from outside (configuration, CSV, command line).  The message is one line that
/// names file, line, key, value and what is allowed; `main` prints it and ends with status 2.
class InputError : public std::runtime_error {
public:
    /// @param message  may quote the input: each ASCII control character in it becomes a blank.
    explicit InputError(std::string message)
        : std::runtime_error(in_one_line(std::move(message))) {}

private:
    static std::string in_one_line(std::string text) {
        // A char is signed on amd64 and unsigned on arm64.
        const auto is_control = [](char c) {
            return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
        };
        std::replace_if(text.begin(), text.end(), is_control, ' ');
        return text;
    }
};

}  // namespace a351
