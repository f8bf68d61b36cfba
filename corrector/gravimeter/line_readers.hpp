#pragma once
/// @file
/// The formats, line by line.
///
/// A format has a function that recognises its first significant line, and one that makes a
/// LineReader.

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

/// Takes the lines of a file in order, without their ends, and keeps what a header says about the
/// readings after it.
class LineReader {
public:
    virtual ~LineReader() = default;
    /// Takes the whole text before its lines, for what only all of them together prove.
    virtual void look_at(std::string_view /*text*/) {}
    [[nodiscard]] virtual Line read(std::string_view line) = 0;
    /// Returns which layout the last reading had, for people.
    [[nodiscard]] virtual std::string layout() const = 0;
    /// Returns the points of the whole file that a person should check; empty if there are none.
    [[nodiscard]] virtual std::string remark() const { return {}; }
};

/// A format: its name, the line by which it is known, and its reader.
struct Format {
    std::string_view name;
    std::string_view forms;  ///< Forms of its files that are read, for people.
    std::function<bool(std::string_view line)> begins_with;
    /// Returns null if the files of this format do not say what an option has to say.
    std::function<std::unique_ptr<LineReader>(const ReadOptions& options)> make_reader;
};

/// Returns which known form, not read, a line belongs to, and the remedy; empty if none.
[[nodiscard]] std::string unread_form(std::string_view line);

/// Scintrex CG-5: headers that begin with `/`, then readings between blanks.
[[nodiscard]] Format cg5_format();
/// All forms that are data: headers, a line of names, then readings between separators.  The CG-6.
[[nodiscard]] std::vector<Format> named_formats();
/// The files of Lynx LG, the program of the CG-6: headers that begin with `/`, then readings between
/// blanks.
[[nodiscard]] Format cg6_export_format();
/// Tables of readings in a zone that the file does not say.
[[nodiscard]] Format gcym_format();
/// ZLS Burris: readings between tabs, commas or blanks, with or without a line of names.
[[nodiscard]] Format burris_format();

}  // namespace a351::corrector::gravimeter
