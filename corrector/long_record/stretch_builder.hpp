#pragma once
/// @file
/// Samples of three axes (or their norm) and temperature, block by block, to a RecordStretch.

#include <cstdint>
#include <span>
#include <vector>

#include "corrector/long_record/long_record.hpp"
#include "protocol/signal/decimator.hpp"

namespace a351::corrector {

/// Decimates as it goes: memory grows with the output only.  Axes are decimated first and their norm
/// is taken afterwards, so that vibration does not rectify.
class StretchBuilder {
public:
    /// @param stages  0 to kMostRecordStages of 10.
    /// @param axes    3 (x, y, z) or 1 (their norm).
    StretchBuilder(int stages, std::size_t axes);

    /// Inputs from one sample of the output to the next.
    [[nodiscard]] std::int64_t inputs_per_sample() const noexcept { return inputs_per_sample_; }

    /// Takes samples that follow the last ones, mGal and degC, NaN where missing.
    /// @param channels  the axes, then the temperature; all of the same length.
    void push(const std::vector<std::vector<double>>& channels);

    /// Of the input that is sample `k` of the output; those never given follow the one before them.
    void set_time(std::int64_t k, UtcTime time);

    [[nodiscard]] std::int64_t input_count() const noexcept { return input_count_; }

    /// What has been pushed, as a stretch.
    /// @param step_s  from output to output where no time was given.
    /// @pre input_count() > 0 and the time of output 0 was given.
    [[nodiscard]] RecordStretch finish(double step_s);

private:
    void add_to_ranges(const std::vector<std::vector<double>>& channels);

    std::int64_t inputs_per_sample_ = 1;
    std::vector<Decimator> decimators_;         ///< One per channel; none without a stage.
    std::vector<std::vector<double>> outputs_;  ///< One per channel.
    std::vector<RecordStretch::RawRange> raw_;
    std::vector<UtcTime> times_;
    std::vector<bool> has_time_;
    std::int64_t input_count_ = 0;
};

}  // namespace a351::corrector
