#pragma once
/// @file
/// A table for people, as text on a terminal or in a report.

#include <string>
#include <vector>

namespace a351::corrector::result {

/// A table for people, with texts that are ready to be shown.
///
/// Invariant: `alignment`, `headings` and every row have the same length.  Whoever adds a column by
/// hand must extend all three.
struct Table {
    std::string alignment;                       ///< One letter per column: Shown::alignment.
    std::vector<std::string> headings;           ///< One per column.
    std::vector<std::vector<std::string>> rows;  ///< One text per column each.
};

/// Returns a table as lines of text, the headings first, in the language of the program.
///
/// The first column is aligned left and the others right.  `alignment` has no effect here; it is
/// for HTML.  Letters of two columns on a terminal count as two (text::aligned()).
[[nodiscard]] std::string aligned_text(const Table& table);

}  // namespace a351::corrector::result
