#pragma once
/// @file
/// The error of an input from outside, which a person can correct.
///
/// Use it for a file or an option that breaks its format.  Do not use it for a fault of the caller,
/// which is std::invalid_argument, or for a file that cannot be written, which is
/// std::system_error.  A failure that the caller expects is a returned value, not an exception.

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace a351 {

/// Error in an input from outside (configuration, CSV, command line).  The message is one line that
/// names file, line, key, value and what is allowed; `main` prints it and ends with status 2.
///
///     c.toml:4: s.c = 70: out of range; allowed: a number from 0 to 60
///
/// The class does not check this form.  Readers of files have functions that build it:
/// text::CsvTable::refuse(), text::CsvReader::refuse() and text::TomlTable::refuse().
class InputError : public std::runtime_error {
public:
    /// Keeps the message, which what() returns.  Bytes from 80h on, as in UTF-8, are unchanged.
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
