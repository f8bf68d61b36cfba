#include "corrector/command/progress_bar.hpp"

namespace a351::corrector {
namespace {

constexpr std::chrono::seconds kSilence(2);
constexpr std::size_t kBarWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::ostream& out, bool is_terminal, std::string label)
    : out_(out),
      is_terminal_(is_terminal),
      label_(std::move(label)),
      start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
    if (width_ > 0) out_ << '\r' << std::string(width_, ' ') << '\r' << std::flush;
}

void ProgressBar::show(std::size_t done, std::size_t total) {
    if (!is_terminal_ || std::chrono::steady_clock::now() - start_ < kSilence) return;
    const std::size_t filled = total == 0 ? kBarWidth : kBarWidth * done / total;
    const std::string line = label_ + " [" + std::string(filled, '#') +
                             std::string(kBarWidth - filled, ' ') + "] " + std::to_string(done) +
                             "/" + std::to_string(total);
    width_ = line.size();
    out_ << '\r' << line << std::flush;
}

}  // namespace a351::corrector
