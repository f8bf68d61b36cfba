#pragma once
/// @file
/// The derived channels: means and states at whole UTC seconds, from the samples and their times.
/// Like the samples they are a pure function of the journal.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/channel_packer.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/oven/controller_values.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::record {

/// Answer of the oven's controller.
struct OvenSample {
    UtcTime utc;
    oven::ControllerValues values;
    std::int64_t index = 0;  ///< Newest sample of the sensor at that time.
};

/// Makes the channels of the oven: LK2 process value, LK3 set point, both in 0.001 degC, and LYH
/// heating in 0.01 %.  Samples are `interval` apart.  An answer is taken for a place if it comes
/// less than 1 s before or after it (0.6 s at an interval of 1 s); of several answers the first one
/// counts.  After a pause the next answer begins a new row, on the nearest second.  A process value
/// is missing if the status reports an input error.
class OvenChannels {
public:
    explicit OvenChannels(std::chrono::seconds interval)
        : interval_(interval),
          temperature_(kOvenTemperature, interval),
          set_point_(kOvenSetPoint, interval),
          heating_(kOvenHeating, interval) {}

    [[nodiscard]] std::chrono::seconds interval() const noexcept { return interval_; }

    void add(const RecordContext& context, const OvenSample& sample);

    void pass(const RecordContext& context, UtcTime now);
    void close(const RecordContext& context, bool ends_series);

private:
    std::chrono::seconds interval_;
    std::optional<std::chrono::sys_seconds> newest_;
    SecondPacker temperature_, set_point_, heating_;
};

/// Makes the derived channels of one session.  It is placed between the packers of the sampled
/// channels and the archive, so that it sees where their records begin.
///
///     LK1  mean of the sensor's temperature over [s, s + 1 s), in 0.001 degC
///     LCQ  timing quality of the last sample of that second, as known at its end
///     LCE  time of a sample minus its time by start and rate of its record, in us; for the last
///          sample at or before s and the records of the first channel of the layout
///     LK2, LK3, LYH  the oven's answers, at the oven's interval: OvenChannels
///
/// LK1 and LCQ have a value for a second if samples of the seconds before and after it were seen,
/// by the clock's fixed times.  The first and the last second of a run and one in which the times
/// jump have none.  So a second never depends on where a process or a record ended.  Missing
/// samples are left out of the mean.
class SlowChannels final : public ArchiveSink {
public:
    /// @param context  context of the archive itself; the objects it refers to must outlive this.
    SlowChannels(const wire::DeviceProfile& profile, const RecordContext& context);

    /// Begins a run; its indices begin at 0.  @param reference  channel whose records LCE refers
    /// to.
    void begin_run(std::string reference, bool has_temperature);

    /// Sets the sample interval of the oven's channels from now on.
    void use_oven_interval(std::chrono::seconds interval);

    /// Adds a sample of the sensor.
    void add(std::int64_t index, std::int32_t temperature_counts);

    /// Adds a poll of the oven.
    /// @param after  time from the instant of sample `index`, the newest, to the poll.
    void add(std::int64_t index, Nanoseconds after, const OvenChunk& poll);

    /// Closes records that are old at `now`.
    void pass(UtcTime now);

    /// Packs all known samples.
    void close(bool ends_series);

    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override;
    [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                UtcTime start) const override;

private:
    struct Waiting {
        std::int64_t index = 0;
        std::int32_t temperature_counts = 0;
    };
    struct WaitingPoll {
        std::int64_t index = 0;
        Nanoseconds after{0};
        oven::ControllerValues values;
    };
    /// The second in progress.
    struct Second {
        std::chrono::sys_seconds begin;
        bool is_whole = false;  ///< True if it is complete up to now.
        std::int64_t temperature_sum = 0;
        std::int64_t sample_count = 0;
        std::int64_t last_index = 0;
        std::int64_t next_look = 0;  ///< All samples before it lie in this second.
    };

    void take(const Waiting& sample);
    void take(const WaitingPoll& poll);
    void look(std::int64_t index, bool is_entered);
    void finish(const Second& second);

    const wire::DeviceProfile& profile_;
    RecordContext context_;
    std::string reference_;
    bool has_temperature_ = false;
    // Samples and polls wait until their times are fixed: for the first 2 s of a run's data.
    std::vector<Waiting> waiting_;
    std::vector<WaitingPoll> waiting_polls_;
    std::optional<Second> second_;
    SecondPacker sensor_temperature_, timing_quality_, clock_error_;
    OvenChannels oven_{kShortestOvenInterval};
};

}  // namespace a351::record
