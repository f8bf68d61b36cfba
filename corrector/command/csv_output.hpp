#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/text/new_file.hpp"

namespace a351::corrector {

/// A table that is written piece by piece to a new or replaced file, or to standard output if
/// `file` is empty.
class CsvOutput {
public:
    /// @throws std::system_error  the file cannot be written; here and in all members.
    explicit CsvOutput(const std::string& file);

    void write(std::string_view text);

    /// Ends the table; without this call nothing is left of a file.
    void finish();

private:
    std::optional<text::NewFile> file_;
};

/// A whole table.
/// @throws std::system_error  the file cannot be written; nothing is left of it.
void write_or_print(const std::string& file, std::string_view csv);

}  // namespace a351::corrector
