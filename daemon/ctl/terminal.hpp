#pragma once
/// @file
/// Text on a terminal: colour, fitting to its size, and a screen that is drawn in place.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace a351::daemon::ctl {

/// Returns true if standard output is a terminal that can be drawn on: not one with TERM=dumb.
[[nodiscard]] bool is_screen();

/// Returns true if it may also be coloured: the environment variable NO_COLOR (no-color.org) is
/// absent or empty.
[[nodiscard]] bool wants_colour();

/// Fits a screen to a terminal: long lines are broken at blanks or before letters of two columns, and
/// indented.  Lines at the end that have no place are left out.
/// @param columns, rows  size of the terminal.
[[nodiscard]] std::string fitted(const std::string& screen, std::size_t columns, std::size_t rows);

struct TerminalSize {
    std::size_t columns = 80, rows = 24;
};

/// A screen of its own on the terminal of standard output, with the keys of standard input.
///
/// The former content and settings of the terminal return with the destructor, and before SIGINT,
/// SIGTERM and SIGHUP end the program with status 0.  At most one exists.
class Terminal {
public:
    Terminal();
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// Returns the present size; 80 x 24 if the terminal does not say.
    [[nodiscard]] TerminalSize size() const;

    /// Draws the screen over the last one.
    /// @param screen     as many lines as fit.
    /// @param is_typing  true: the cursor is visible, after the last letter.
    void show(const std::string& screen, bool is_typing) const;

    /// Waits for keys, at most that long.
    /// @return the bytes typed, empty after a change of the size and without a terminal at standard
    ///         input; std::nullopt if there will be no more.
    [[nodiscard]] std::optional<std::string> keys(int wait_ms) const;
};

}  // namespace a351::daemon::ctl
