#pragma once
/// @file
/// The signal from all that it depends on, and its words in the event log.

#include <functional>
#include <optional>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/status/status.hpp"
#include "daemon/survey/field_status.hpp"
#include "daemon/survey/lasting_word.hpp"
#include "daemon/survey/occupations.hpp"
#include "daemon/survey/so_far.hpp"

namespace a351::daemon::survey {

/// Returns what contradicts a reading and was not answered, the most urgent first: the sensor, another
/// sensor, the box, then the readings.
[[nodiscard]] std::vector<Contradiction> open_contradictions(const status::Status& status,
                                                             const Occupations& occupations,
                                                             const std::optional<MovePrompt>& moved,
                                                             const text::Message& wrong_face,
                                                             const SoFar& so_far);

/// Returns the signal, and adds it to the level and reasons of the status if it is NO DATA or LOOK.
[[nodiscard]] Signal operator_signal(status::Status& status, const verdict::Verdict& verdict,
                                     const std::vector<text::Message>& why,
                                     const Occupations& occupations, const FieldStatus& field,
                                     const SoFar& so_far);

/// Logs the words of the signal in the time of the data: one is computed for each value of the live
/// series, however seldom advance() is called.  Not thread-safe: the page's thread owns it.
class SignalLog {
public:
    /// @param note  writes an event.
    SignalLog(const Occupations& occupations, const live::Record& live,
              std::function<void(const events::Event&)> note)
        : occupations_(occupations), live_(live), note_(std::move(note)) {}

    /// Logs the words since the last call, up to the last sample.  It is called once a second and
    /// before each change of the occupations.
    /// @return the word at the last sample
    Word advance(const status::Status& status, const SoFar& so_far);

private:
    const Occupations& occupations_;
    const live::Record& live_;
    std::function<void(const events::Event&)> note_;
    std::optional<UtcTime> end_;
    LastingWord lasting_;
    Word word_ = Word::no_data;
};

}  // namespace a351::daemon::survey
