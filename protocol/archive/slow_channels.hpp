#pragma once
/// @file
/// The derived channels: means and states at whole UTC seconds, from the samples and what
/// is known of their times.  A pure function of the journal, as are the samples.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/oven_channels.hpp"
#include "protocol/archive/second_packer.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::record {

/// Of one session.  Stands between the packers of the sampled channels and the archive, to see where
/// their records begin.
///
///     LK1  mean of the sensor's temperature over [s, s + 1 s), in 0.001 degC
///     LCQ  timing quality of the last sample of that second, as known when it was over
///     LCE  time of a sample minus what start and rate of its record say, in us; the last sample at
///          or before s, the records those of the first channel of the layout
///     LK2, LK3, LYH  the oven's answers, at the oven's interval: OvenChannels
///
/// LK1 and LCQ have a second when its samples were met from the one before to the one after, by the
/// clock's fixed times: not the first and the last of a run, nor one in which the times jump.  So a
/// second never depends on where a process or a record ended.  Samples missing within do not count.
class SlowChannels final : public ArchiveSink {
public:
    /// @param context  of the archive itself; what it refers to must outlive this.
    SlowChannels(const wire::DeviceProfile& profile, const RecordContext& context);

    /// Indices begin at 0.  @param reference  channel whose records LCE is told of.
    void begin_run(std::string reference, bool has_temperature);

    /// From sample to sample of the oven's channels, from now on.
    void use_oven_interval(std::chrono::seconds interval);

    void add(std::int64_t index, std::int32_t temperature_counts);

    /// @param after  from the instant of sample `index`, the newest, to the poll.
    void add(std::int64_t index, Nanoseconds after, const OvenChunk& poll);

    /// Closes records that are old by now.
    void pass(UtcTime now);

    /// Packs all that is known.
    void close(bool ends_series);

    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override;
    [[nodiscard]] std::optional<std::size_t> samples_held(const std::string& channel,
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
    /// The one that is running.
    struct Second {
        std::chrono::sys_seconds begin;
        bool is_whole = false;  ///< So far.
        std::int64_t temperature_sum = 0;
        std::int64_t sample_count = 0;
        std::int64_t last_index = 0;
        std::int64_t next_look = 0;  ///< All samples before it lie in this second.
    };

    void take(const Waiting& sample);
    void take(const WaitingPoll& poll);
    void look(std::int64_t index, bool is_entered);
    void finish(const Second& second);
    [[nodiscard]] double header_rate_hz() const;

    const wire::DeviceProfile& profile_;
    RecordContext context_;
    std::string reference_;
    bool has_temperature_ = false;
    // Until their times are fixed: 2 s of a run's data.
    std::vector<Waiting> waiting_;
    std::vector<WaitingPoll> waiting_polls_;
    std::optional<Second> second_;
    SecondPacker sensor_temperature_, timing_quality_, clock_error_;
    OvenChannels oven_{kShortestOvenInterval};
};

}  // namespace a351::record
