#include "protocol/signal/decimator.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace a351::signal {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Outputs made from one filling of the rows; for a factor of ten the rows fit in the first-level
/// cache.
constexpr std::size_t kOutputsPerFilling = 64;

}  // namespace

Decimator::Stage::Stage(const DecimationFilter& filter)
    : factor_(filter.factor),
      half_width_(filter.half_width()),
      column_count_(kOutputsPerFilling + 2 * half_width_ / factor_),
      row_size_(column_count_ + kSideBySide),
      phases_(factor_ * row_size_, kMissing),
      sum_tap_pairs_(sum_tap_pairs_variants().back()),
      stored_(half_width_) {  // values before the first sample are missing
    const auto place = [this](std::size_t i) { return (i % factor_) * row_size_ + i / factor_; };
    const auto pair = [&](std::size_t j) {
        return TapPair{filter.taps[half_width_ + j], place(half_width_ - j),
                       place(half_width_ + j)};
    };
    for (std::size_t j = half_width_; j >= 1; --j) pairs_.push_back(pair(j));
    centre_ = pair(0);
}

void Decimator::Stage::push(std::span<const double> input, std::vector<double>& output) {
    while (!input.empty()) {
        const std::size_t count = std::min(input.size(), capacity() - stored_);
        store(input.first(count));
        input = input.subspan(count);
        emit(output);
        if (stored_ == capacity()) make_room();
    }
}

void Decimator::Stage::finish(std::vector<double>& output) {
    push(std::vector<double>(half_width_, kMissing), output);
}

void Decimator::Stage::store(std::span<const double> input) {
    std::size_t row = stored_ % factor_;
    double* column = phases_.data() + stored_ / factor_;
    stored_ += input.size();
    for (std::size_t i = 0; i < std::min(factor_, input.size()); ++i) {
        double* to = column + row * row_size_;
        for (std::size_t k = i; k < input.size(); k += factor_) *to++ = input[k];
        if (++row == factor_) {
            row = 0;
            ++column;
        }
    }
}

void Decimator::Stage::emit(std::vector<double>& output) {
    const std::size_t reach = 2 * half_width_;
    const std::size_t complete = stored_ > reach ? (stored_ - reach - 1) / factor_ + 1 : 0;
    for (; emitted_ < complete; emitted_ += kSideBySide) {
        const Outputs outputs = filter_from(emitted_);
        const auto end = outputs.begin() + std::min(kSideBySide, complete - emitted_);
        output.insert(output.end(), outputs.begin(), end);
    }
    emitted_ = complete;
}

/// Forgets the samples that no later output needs.
void Decimator::Stage::make_room() {
    for (std::size_t row = 0; row < factor_; ++row) {
        const auto begin = phases_.begin() + static_cast<std::ptrdiff_t>(row * row_size_);
        std::copy(begin + static_cast<std::ptrdiff_t>(emitted_),
                  begin + static_cast<std::ptrdiff_t>(column_count_), begin);
    }
    stored_ -= emitted_ * factor_;
    emitted_ = 0;
}

/// Returns the outputs `first` and following; those after the last complete one are meaningless.
Decimator::Stage::Outputs Decimator::Stage::filter_from(std::size_t first) const {
    // From the outside in: the smallest terms first.  A NaN among the inputs makes the sum NaN.
    Outputs outputs;
    sum_tap_pairs_(pairs_, phases_.data() + first, outputs.data());
    const double* const centre = phases_.data() + centre_.left + first;
    for (std::size_t i = 0; i < kSideBySide; ++i) {
        const double sum = outputs[i] + centre_.tap * centre[i];
        outputs[i] = std::isfinite(sum) ? sum : kMissing;
    }
    return outputs;
}

Decimator::Decimator(const DecimationFilter& filter, int stages)
    : stages_(static_cast<std::size_t>(std::max(stages, 0)), Stage(filter)), made_(stages_.size()) {
    if (stages < 1) {
        throw std::invalid_argument(fmt::format("Decimator: stages = {}, must be >= 1", stages));
    }
}

void Decimator::push(std::span<const double> input, std::vector<double>& output) {
    require_unfinished();
    push_from(0, input, output);
}

void Decimator::finish(std::vector<double>& output) {
    require_unfinished();
    is_finished_ = true;
    for (std::size_t k = 0; k < stages_.size(); ++k) {
        made_[k].clear();
        stages_[k].finish(made_[k]);
        push_from(k + 1, made_[k], output);
    }
}

void Decimator::require_unfinished() const {
    if (is_finished_) throw std::logic_error("Decimator: used after finish()");
}

/// Passes `input` through stage k and all later ones.
void Decimator::push_from(std::size_t k, std::span<const double> input,
                          std::vector<double>& output) {
    if (k == stages_.size()) {
        output.insert(output.end(), input.begin(), input.end());
        return;
    }
    made_[k].clear();
    stages_[k].push(input, made_[k]);
    push_from(k + 1, made_[k], output);
}

}  // namespace a351::signal
