#pragma once
/// @file
/// miniSEED files of a data root's archive as a recording.
/// Format: protocol/archive/archive-format.md.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/replay/recording.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim::replay {

/// Samples of three axes and temperature, joined by time: values within half a sampling period of
/// each other are one sample.  An instant that some channel lacks is left out.  The index advances
/// by the time since the sample before, in whole periods and at least by one, so that COUNT shows
/// gaps.  Times are those of the records.
///
/// Holds one day file of each channel in memory.
class ArchiveSource final : public signal::SampleSource {
public:
    static constexpr std::array<const char*, 4> kFields{"x", "y", "z", "temperature"};

    /// @param files  records of kRecordSize; files of other channels are ignored.
    /// @param axes   last letter of the channels of x, y, z.
    /// @throws InputError  a file does not begin with a record of an archive; two stations; two
    ///         rates; an axis that `axes` does not name; no axis at all.
    ArchiveSource(const std::vector<std::filesystem::path>& files,
                  const std::array<std::string, 3>& axes);
    ~ArchiveSource() override;

    [[nodiscard]] int rate_hz() const noexcept override { return rate_hz_; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override;
    [[nodiscard]] signal::TimedSample next() override;

    /// Returns true if the sample that next() would return is the first of a run of sampling, as
    /// marked in its record.
    [[nodiscard]] bool begins_run() const noexcept { return begins_run_; }

    /// Returns true if field x, y, z or temperature (0 ... 3) was archived; otherwise it reads 0.
    [[nodiscard]] bool has_field(std::size_t field) const { return channels_.at(field) != nullptr; }

    /// Returns the number of instants left out because a channel lacked them.
    [[nodiscard]] std::int64_t incomplete() const noexcept { return incomplete_; }

    [[nodiscard]] const std::vector<RecordingDamage>& damage() const noexcept { return damage_; }

private:
    class Channel;

    void advance();

    std::array<std::unique_ptr<Channel>, 4> channels_;
    int rate_hz_ = 0;
    std::vector<RecordingDamage> damage_;
    std::optional<signal::TimedSample> next_;
    bool begins_run_ = false;  ///< next_ is the first sample of a run.
    std::int64_t incomplete_ = 0;
};

/// An archive as a recording: its samples are encoded again in the layout that the host configures.
/// A session is a run of sampling, as marked by the flags of the records.  COUNT begins with one
/// step at each start of sampling and jumps over missing samples.  FLAG comes from the emulated
/// unit.  An archive does not hold the samples that a unit suppresses while its filter fills, so no
/// archived sample is suppressed.
class ArchiveRecording final : public Recording {
public:
    /// @param unit  the unit to emulate, which an archive does not name.
    ArchiveRecording(std::unique_ptr<ArchiveSource> source, RecordedUnit unit);

    [[nodiscard]] const RecordedUnit& unit() const override { return unit_; }
    [[nodiscard]] std::optional<UtcTime> next_due(
        const device::RegisterMachine& machine) const override;
    void send_next(device::RegisterMachine& machine, UtcTime leaves,
                   device::LineSink& line) override;
    bool begin_next_session() override;
    [[nodiscard]] std::string objection(const device::RegisterMachine& machine) const override;
    [[nodiscard]] const std::vector<RecordingDamage>& damage() const override {
        return source_->damage();
    }
    [[nodiscard]] std::int64_t incomplete_samples() const override { return source_->incomplete(); }

private:
    std::unique_ptr<ArchiveSource> source_;
    RecordedUnit unit_;
    bool is_session_over_ = false;
    int run_ = 0;  ///< Sampling run of the machine in which the last piece was sent.
    std::int64_t next_index_ = 0;  ///< Index after that piece.
    std::vector<std::byte> bytes_;
};

}  // namespace a351::sim::replay
