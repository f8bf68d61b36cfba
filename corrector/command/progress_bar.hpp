#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace a351::corrector {

/// A line `label [####    ] 3/19` on standard error that redraws itself, for work of more than two
/// seconds on a terminal; otherwise silent.  Not for several threads at once.
class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();  ///< Clears the line.

    /// Shows the progress; a reference to the bar is a function of this form.
    void operator()(std::size_t done, std::size_t total);

private:
    std::string label_;
    bool is_terminal_;
    std::chrono::steady_clock::time_point start_;
    std::size_t width_ = 0;  ///< Width of the line on the screen.
};

}  // namespace a351::corrector
