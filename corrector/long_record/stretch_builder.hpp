#pragma once
/// @file
/// Builds a RecordStretch from blocks of samples.
///
///     StretchBuilder builder(3, 3);  // from 50 Hz; x, y, z
///     builder.set_time(0, start);
///     for (const auto& block : blocks) builder.push(block);
///     RecordStretch stretch = builder.finish(20.0);
///     stretch.serial_number = serial_number;
///
/// The caller counts the samples: a gap is a run of NaN of the right length, and a gap that is too
/// long needs a new builder.

#include <cstdint>
#include <optional>
#include <vector>

#include "corrector/long_record/long_record.hpp"
#include "protocol/signal/decimator.hpp"

namespace a351::corrector::long_record {

/// Builds a stretch from samples of three axes (or their norm) and temperature.
///
/// Samples are decimated as they arrive, so that memory grows with the output only.  Axes are
/// decimated first and their norm is taken afterwards, so that vibration is not rectified.  Blocks
/// of any size give the same stretch (record_reading_test.cpp).
///
/// A missing input makes all outputs NaN that depend on it.  The first and the last outputs are NaN
/// too, because their filters are not filled.  Output k is centred on input k x inputs_per_sample()
/// and has its time.  Not thread-safe.
class StretchBuilder {
public:
    /// @param stages  number of decimation stages of 10, 0 to kMostRecordStages.
    ///                0 takes the samples as they are; then the stretch has no raw ranges.
    /// @param axes    3 (x, y, z) or 1 (their norm); with 1 the stretch has no axes.
    StretchBuilder(int stages, std::size_t axes);

    /// Returns the number of input samples per output sample.
    [[nodiscard]] std::int64_t inputs_per_sample() const noexcept { return inputs_per_sample_; }

    /// Adds samples that follow the last ones; NaN if missing.
    /// @param channels  the axes (mGal), then the temperature (degC); all of the same length, not
    ///                  checked.  Empty channels are allowed.
    void push(const std::vector<std::vector<double>>& channels);

    /// Sets the time of output sample `k`.  A sample without a time is one step after the sample
    /// before.
    ///
    /// The time is that of input sample k x inputs_per_sample().  It may be set before or after
    /// this input is added.  Times beyond the last output sample are dropped.
    /// @param k  >= 0.
    void set_time(std::int64_t k, UtcTime time);

    /// Returns the number of input samples added, missing ones included.  It is the number of the
    /// next one.
    [[nodiscard]] std::int64_t input_count() const noexcept { return input_count_; }

    /// Returns all samples as a stretch; the builder cannot be used again.
    ///
    /// It has ceil(n / inputs_per_sample()) samples for n inputs.  Serial number and `begins_with`
    /// are empty.
    /// @param step_s  time between output samples, s, for those without a time.
    /// @pre input_count() > 0, and the time of output sample 0 was set.
    [[nodiscard]] RecordStretch finish(double step_s);

private:
    void add_to_ranges(const std::vector<std::vector<double>>& channels);

    std::int64_t inputs_per_sample_ = 1;
    std::vector<signal::Decimator> decimators_;  ///< One per channel; empty without stages.
    std::vector<std::vector<double>> outputs_;   ///< One per channel.
    std::vector<RecordStretch::RawRange> raw_;
    std::vector<std::optional<UtcTime>> times_;
    std::int64_t input_count_ = 0;
};

}  // namespace a351::corrector::long_record
