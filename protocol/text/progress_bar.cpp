#include "protocol/text/progress_bar.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <iostream>

namespace a351::text {
namespace {

constexpr std::chrono::seconds kSilence(2);
constexpr std::size_t kBarWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
    if (width_ > 0) std::cerr << '\r' << std::string(width_, ' ') << '\r' << std::flush;
}

void ProgressBar::operator()(std::size_t done, std::size_t total) {
    if (!is_terminal_ || std::chrono::steady_clock::now() - start_ < kSilence) return;
    const std::size_t filled = total == 0 ? kBarWidth : kBarWidth * done / total;
    const std::string line = fmt::format("{} [{}{}] {}/{}", label_, std::string(filled, '#'),
                                         std::string(kBarWidth - filled, ' '), done, total);
    width_ = line.size();
    std::cerr << '\r' << line << std::flush;
}

}  // namespace a351::text
