#pragma once
/// @file
/// Output of the commands that write one table: a file, or standard output for a pipe.
///
///     CsvOutput output(options.output);  // "": standard output
///     while (more()) output.write(next_rows());
///     output.finish();
///
/// A reader never sees half a file, because it gets its name only at the end.  A reader of standard
/// output sees the pieces as they come.

#include <optional>
#include <string>
#include <string_view>

#include "protocol/text/new_file.hpp"

namespace a351::corrector::command {

/// A table that is written piece by piece to a new or replaced file, or to standard output if
/// `file` is empty.
///
/// Missing folders of the file are created.  It is a temporary file beside its place until
/// finish().  Text is written as it is; line ends are up to the caller.  Errors of standard output
/// are not reported here: check std::cout at the end.
class CsvOutput {
public:
    /// Opens the output.
    /// @param file  path, relative to the working directory; empty: standard output.
    /// @throws std::system_error  the file cannot be written; here and in all members.
    explicit CsvOutput(const std::string& file);

    /// Appends a piece of the table.  The first piece should have the header.
    void write(std::string_view text);

    /// Ends the table; without this call nothing is left of a file.  Call it once, after the last
    /// write().
    void finish();

private:
    std::optional<text::NewFile> file_;
};

/// A whole table.  Writes it in one step; use CsvOutput if it is too long for memory.
/// @param file  as of CsvOutput.
/// @param csv   header and rows, each with its line end.
/// @throws std::system_error  the file cannot be written; nothing is left of it.
void write_or_print(const std::string& file, std::string_view csv);

}  // namespace a351::corrector::command
