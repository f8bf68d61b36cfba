#pragma once
/// @file
/// Journal segments as a recording: the received bytes as they came, including damage.
/// Format: protocol/journal/journal-format.md.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/replay/recording.hpp"

namespace a351::sim::replay {

/// A piece is the result of one read().  It is due at the host's raw time of its read, converted to
/// UTC by the first clock reading of each boot of the recording host.  Later steps of that host's
/// clock are not replayed.  A journal does not contain the answers of the recorded handshake.
/// Segments of one session follow each other without a break.  If the boot differs or raw time runs
/// back, it is another session even under the same identifier.  Sessions without a byte are
/// skipped.  Damaged chunks are left out and reported by damage().
class JournalRecording final : public Recording {
public:
    /// @param segments  in the order of replay; headers are read now, the rest while replaying.
    /// @param damage    damage found before, such as skipped segments.
    /// @throws InputError  a file is not a journal segment, its header names an unknown profile or
    ///         settings that the profile does not have, or no segment has a received byte.
    explicit JournalRecording(std::vector<std::filesystem::path> segments,
                              std::vector<RecordingDamage> damage = {});

    [[nodiscard]] const RecordedUnit& unit() const override { return unit_; }
    [[nodiscard]] std::optional<UtcTime> next_due(
        const device::RegisterMachine& machine) const override;
    void send_next(device::RegisterMachine& machine, UtcTime leaves,
                   device::LineSink& line) override;
    bool begin_next_session() override;
    [[nodiscard]] std::string objection(const device::RegisterMachine& machine) const override;
    [[nodiscard]] const std::vector<RecordingDamage>& damage() const override { return damage_; }

private:
    struct Segment {
        std::filesystem::path file;
        journal::Header header;
        Nanoseconds utc_minus_raw{0};
    };

    [[nodiscard]] const journal::Header& header() const { return segments_[at_].header; }
    void open(std::size_t segment);
    [[nodiscard]] bool is_repeated_later() const;
    bool load_chunk();
    void load_piece();

    std::vector<Segment> segments_;
    std::size_t at_ = 0;  ///< Index of the segment being read.
    RecordedUnit unit_;
    std::optional<journal::Reader> reader_;
    journal::Repetitions repetitions_;
    journal::RxChunk chunk_;
    std::size_t read_ = 0;  ///< Index of the next read of chunk_.
    UtcTime due_;           ///< Due time of that read.
    bool has_piece_ = false;
    std::vector<RecordingDamage> damage_;
};

}  // namespace a351::sim::replay
