#pragma once
/// @file
/// Alternatives to a survey as it was entered, and its residuals under them.
///
/// An alternative is put right by taking its readings, their reference or their offset as unknown, or
/// by exchanging two names.  For white noise each is an update of one factorisation: M without the
/// directions of the known alternatives,
///
///     M' = M - M C (C' M C)^-1 C' M

#include <memory>
#include <vector>

#include "corrector/adjustment/residuals.hpp"
#include "corrector/adjustment/survey_equations.hpp"

namespace a351::corrector::adjustment {

/// Kinds of alternatives.
///
/// - set_up: one set-up of a stay is off.
/// - stay: all set-ups of a stay are off, and the station has another stay.
/// - station: all readings of a station with a reference are off: its reference, its name, or its
///   only stay.
/// - swap: two stays have each other's name.
/// - step: all readings of a loop from one on are off.
enum class AlternativeKind { set_up, stay, station, swap, step };

/// Something that may be wrong with a survey.
struct Alternative {
    AlternativeKind kind = AlternativeKind::stay;
    /// Numbers of the readings that are off; for a step all of its loop from it on.
    Effect readings;
    Effect others;  ///< Swap: readings of the other stay.
    /// Reading minus what the others expect, mGal: positive if the readings are too high.  Swap: the
    /// difference of both references.
    double size_mgal = 0.0;

    /// Returns true for the same alternative, whatever its size.
    [[nodiscard]] bool is_same(const Alternative& other) const {
        return kind == other.kind && readings == other.readings && others == other.others;
    }
};

/// A survey whose alternatives are tried.
class Trials {
public:
    Trials() = default;
    Trials(const Trials&) = delete;
    Trials& operator=(const Trials&) = delete;
    virtual ~Trials() = default;

    /// Returns the residuals with the alternatives `known` put right, at the noise of the survey with
    /// those of `quiet` put right; null if there are none.
    [[nodiscard]] virtual std::shared_ptr<const Residuals> residuals(
        const std::vector<Alternative>& known, const std::vector<Alternative>& quiet) = 0;

    /// Says that residuals() will be asked for at these `quiet` alternatives, so that surveys whose
    /// noises do not depend on each other can find them at the same time.  No residuals change.
    virtual void expect(const std::vector<std::vector<Alternative>>& quiets) {
        static_cast<void>(quiets);
    }
};

/// Returns the trials of a survey with white noise.
/// @param survey  determined; its Q is not needed.
[[nodiscard]] std::unique_ptr<Trials> white_trials(AdjustedSurvey survey);

}  // namespace a351::corrector::adjustment
