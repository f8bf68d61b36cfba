#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/replay/archive_source.hpp"
#include "sim/replay/recording.hpp"

namespace a351::sim {

/// An archive as a recording: samples encoded anew, in the layout that the host configures.  A
/// session is a run of sampling, as the flags of the records tell.  COUNT begins with one step at each start of sampling and jumps where samples are
/// missing; FLAG is the unit's.  The samples that the unit suppresses while its filter fills are not
/// in an archive, so none is lost to it.
class ArchiveRecording final : public Recording {
public:
    /// @param unit  an archive does not tell what it was recorded with.
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
    int run_ = 0;                  ///< Of the machine, in which the last piece was sent.
    std::int64_t next_index_ = 0;  ///< Behind that piece.
    std::vector<std::byte> bytes_;
};

}  // namespace a351::sim
