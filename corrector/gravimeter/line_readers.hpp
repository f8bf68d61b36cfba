#pragma once
/// @file
/// The three formats, line by line.
///
/// A format has a function that recognises its first significant line, and one that makes a
/// LineReader.  The LineReader takes the lines of a file in order, without their ends, and keeps what
/// a header says about the readings after it.

#include <functional>
#include <string>
#include <string_view>
#include <variant>

#include "corrector/gravimeter/gravimeter_file.hpp"

namespace a351::corrector::gravimeter {

/// A header, a line of column names or a blank line.
struct Comment {};

/// Reason why a line is refused.
struct Refusal {
    std::string reason;
};

/// A line of a file; the number of a reading's line is not set.
using Line = std::variant<Comment, Reading, Refusal>;
using LineReader = std::function<Line(std::string_view)>;

/// A format: its name, the line by which it is known, and its reader.
struct Format {
    std::string_view name;
    bool (*begins_with)(std::string_view line);
    LineReader (*make_reader)();
};

/// Scintrex CG-5: headers that begin with `/`, then readings of 15 columns between blanks.
[[nodiscard]] Format cg5_format();
/// Scintrex CG-6: headers that begin with `/`, the last with the names of the columns, then readings
/// between tabs.
[[nodiscard]] Format cg6_format();
/// ZLS Burris: no header; readings of 16 columns between blanks or commas.
[[nodiscard]] Format burris_format();

}  // namespace a351::corrector::gravimeter
