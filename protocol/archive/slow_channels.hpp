#pragma once
/// @file
/// The derived channels: means and states at whole UTC seconds, from the samples and their times.
/// Like the samples they are a pure function of the journal.
///
/// Archiver uses it between its packers and the sink.  The values do not depend on where records
/// end (slow_channels_test.cpp); protocol/archive/archive-format.md describes them for readers.

#include <array>
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

namespace a351::archive {

/// Answer of the oven's controller.
struct OvenSample {
    UtcTime utc;                    ///< Time of the answer.
    oven::ControllerValues values;  ///< Temperatures in degC, heating in percent.
    std::int64_t index = 0;         ///< Newest sample of the sensor at that time.
};

/// Makes the channels of an oven: process value and set point in 0.001 degC, heating in 0.01 %; LK2,
/// LK3, LYH for the inner oven, LK4, LK5, LYO for the outer one.  Samples are `interval` apart.  An answer is taken for a place if it comes
/// less than 1 s before or after it (0.6 s at an interval of 1 s); of several answers the first one
/// counts.  After a pause the next answer begins a new row, on the nearest second.  A process value
/// is missing if the status reports an input error.
class OvenChannels {
public:
    /// Begins the three channels without samples.
    /// @param interval  time from sample to sample, 1 s to 1 h; not checked.
    OvenChannels(journal::OvenPlace place, std::chrono::seconds interval);

    /// Returns the time from sample to sample.
    [[nodiscard]] std::chrono::seconds interval() const noexcept { return interval_; }

    /// Adds an answer, or drops it if it comes before the next place.  One that is more than 2 s
    /// older than the newest sample begins a new row, because the host's clock was set back.
    void add(const RecordContext& context, const OvenSample& sample);

    /// Drops all samples and begins again with this interval.
    void restart(std::chrono::seconds interval) { *this = OvenChannels(place_, interval); }

    /// Closes records that are old at `now`: 60 samples, but at most an hour.
    void pass(const RecordContext& context, UtcTime now);
    /// Packs all samples.  @param ends_series  marks the last records as the end of the run.
    void close(const RecordContext& context, bool ends_series);

private:
    journal::OvenPlace place_;
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
///     LK4, LK5, LYO  those of the outer oven, at its interval
///
/// LK1 and LCQ have a value for a second if samples of the seconds before and after it were seen,
/// by the clock's fixed times.  The first and the last second of a run and one in which the times
/// jump have none.  So a second never depends on where a process or a record ended.  Missing
/// samples are left out of the mean.
///
/// Samples and polls wait until their times are fixed.  LCE gets its values when a record of the
/// reference channel ends, LK1 and LCQ when a second is over.  Not thread-safe.
class SlowChannels final : public Sink {
public:
    /// Begins without a run; begin_run() must be called before any sample is added.
    /// @param profile  converts the temperature; must outlive this.
    /// @param context  context of the archive itself; the objects it refers to must outlive this.
    SlowChannels(const wire::DeviceProfile& profile, const RecordContext& context);

    /// Begins a run; its indices begin at 0.  @param reference  channel whose records LCE refers
    /// to.
    /// @param has_temperature  false if the layout has no temperature: then there is no LK1.
    ///
    /// Samples that were not packed are dropped; close() must be called before.
    void begin_run(std::string reference, bool has_temperature);

    /// Sets the sample interval of an oven's channels from now on.  Another interval ends their
    /// records; the same one changes nothing.
    void use_oven_interval(journal::OvenPlace place, std::chrono::seconds interval);

    /// Adds a sample of the sensor.  The context's clock must have observed it.
    /// @param index               rises from call to call; missing samples are left out.
    /// @param temperature_counts  raw counts; not used if the layout has no temperature.
    void add(std::int64_t index, std::int32_t temperature_counts);

    /// Adds a poll of an oven.  A poll without an answer, or with another number of registers
    /// than expected, is ignored.
    /// @param after  time from the instant of sample `index`, the newest, to the poll.
    void add(std::int64_t index, Nanoseconds after, const journal::OvenChunk& poll);

    /// Closes records that are old at `now`, which the stream may not show: the sensor may be
    /// silent.
    void pass(UtcTime now);

    /// Packs all known samples.  The second in progress is kept, and so are samples and polls whose
    /// times are not fixed.
    /// @param ends_series  marks the last records as the end of the run.
    void close(bool ends_series);

    /// Passes a record to the archive and, for the reference channel, computes LCE from it.
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
        journal::OvenPlace place = journal::OvenPlace::inner;
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
    [[nodiscard]] OvenChannels& of(journal::OvenPlace place) {
        return ovens_.at(static_cast<std::size_t>(place));
    }

    const wire::DeviceProfile& profile_;
    RecordContext context_;
    std::string reference_;
    bool has_temperature_ = false;
    // Samples and polls wait until their times are fixed: for the first 2 s of a run's data.
    std::vector<Waiting> waiting_;
    std::vector<WaitingPoll> waiting_polls_;
    std::optional<Second> second_;
    SecondPacker sensor_temperature_, timing_quality_, clock_error_;
    /// In the order of OvenPlace.
    std::array<OvenChannels, 2> ovens_{
        OvenChannels(journal::OvenPlace::inner, journal::kShortestOvenInterval),
        OvenChannels(journal::OvenPlace::outer, journal::kShortestOvenInterval)};
};

}  // namespace a351::archive
