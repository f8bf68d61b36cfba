#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/replay/archive_source.hpp"
#include "sim/replay/recording.hpp"

namespace a351::sim {

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
    [[nodiscard]] std::optional<UtcTime> next_due(const RegisterMachine& machine) const override;
    void send_next(RegisterMachine& machine, UtcTime leaves, LineSink& line) override;
    bool begin_next_session() override;
    [[nodiscard]] std::string objection(const RegisterMachine& machine) const override;
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

}  // namespace a351::sim
