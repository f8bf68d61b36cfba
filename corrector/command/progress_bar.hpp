#pragma once

#include <chrono>
#include <cstddef>
#include <ostream>
#include <string>

namespace a351::corrector {

/// A line `label [####    ] 3/19` that redraws itself, for work of more than two seconds on a
/// terminal; otherwise silent.  Not for several threads at once.
class ProgressBar {
public:
    /// @param out  standard error; drawn on only if `is_terminal`.
    ProgressBar(std::ostream& out, bool is_terminal, std::string label);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();  ///< Clears the line.

    void show(std::size_t done, std::size_t total);

private:
    std::ostream& out_;
    bool is_terminal_;
    std::string label_;
    std::chrono::steady_clock::time_point start_;
    std::size_t width_ = 0;  ///< Width of the line on the screen.
};

}  // namespace a351::corrector
