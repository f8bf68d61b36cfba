#pragma once
/// @file
/// Journal segments as a recording: the received bytes as they came, damage included.
/// protocol/journal/journal-format.md.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/journal/journal_reader.hpp"
#include "sim/replay/recording.hpp"

namespace a351::sim {

/// A piece is what one read() gave.  Pieces fall due at the host's raw time of their reads, laid on
/// UTC by the first clock reading of each boot of the recording host: steps of its clock in between
/// are not replayed.  Answers of the recorded handshake are no part of a journal.  Segments of one
/// session follow each other without a break; where the boot is another, or raw time runs back, it
/// is another session even under the same identifier.  Sessions without a byte are passed over.  A damaged
/// tail is left out and told of by damage().
class JournalRecording final : public Recording {
public:
    /// @param segments  in the order to replay; their headers are read at once, the rest bit by bit.
    /// @param damage    met before: what was passed over.
    /// @throws InputError  a file is no journal segment, its header names an unknown profile or
    ///         settings that the profile lacks, or no byte was received in all of them.
    explicit JournalRecording(std::vector<std::filesystem::path> segments,
                              std::vector<RecordingDamage> damage = {});

    [[nodiscard]] const RecordedUnit& unit() const override { return unit_; }
    [[nodiscard]] std::optional<UtcTime> next_due(const RegisterMachine& machine) const override;
    void send_next(RegisterMachine& machine, UtcTime leaves, LineSink& line) override;
    bool begin_next_session() override;
    [[nodiscard]] std::string objection(const RegisterMachine& machine) const override;
    [[nodiscard]] const std::vector<RecordingDamage>& damage() const override { return damage_; }

private:
    struct Segment {
        std::filesystem::path file;
        record::JournalHeader header;
        Nanoseconds utc_minus_raw{0};
    };

    [[nodiscard]] const record::JournalHeader& header() const { return segments_[at_].header; }
    void open(std::size_t segment);
    bool load_chunk();
    void load_piece();

    std::vector<Segment> segments_;
    std::size_t at_ = 0;  ///< Segment being read.
    RecordedUnit unit_;
    std::optional<record::JournalReader> reader_;
    record::Repetitions repetitions_;
    record::RxChunk chunk_;
    std::size_t read_ = 0;  ///< Of chunk_, the next one.
    UtcTime due_;           ///< Of that read.
    bool has_piece_ = false;
    std::vector<RecordingDamage> damage_;
};

}  // namespace a351::sim
