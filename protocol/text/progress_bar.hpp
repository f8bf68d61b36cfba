#pragma once
/// @file
/// Progress of long work on the terminal.
///
///     ProgressBar bar("average");
///     average_occupations(source, stays, std::ref(bar));
///
/// The line is cleared at the end of the bar's life.  End it before other text is written to
/// standard error, else that text is in the same line.

#include <chrono>
#include <cstddef>
#include <string>

namespace a351::text {

/// A line `label [####    ] 3/19` on standard error that redraws itself, for work of more than two
/// seconds on a terminal; otherwise silent.  Not for several threads at once.
///
/// Calls from several threads in turn are allowed, as Progress makes them.  The bar must outlive
/// every std::ref() to it.
class ProgressBar {
public:
    /// Starts the two seconds.
    /// @param label  name of the work, in ASCII, short enough for the line.
    explicit ProgressBar(std::string label);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();  ///< Clears the line.

    /// Shows the progress; a reference to the bar is a function of this form.
    /// @param done   pieces done, at most `total`; not checked.
    /// @param total  pieces in all; 0 shows a full bar.
    void operator()(std::size_t done, std::size_t total);

private:
    std::string label_;
    bool is_terminal_;
    std::chrono::steady_clock::time_point start_;
    std::size_t width_ = 0;  ///< Width of the line on the screen.
};

}  // namespace a351::text
