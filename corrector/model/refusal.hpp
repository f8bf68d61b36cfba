#pragma once
/// @file
/// The answer of a model that cannot be fitted.
///
/// A refusal is a result and no exception, because another model may accept the same rows: `auto`
/// then takes the next one.  correct_survey() makes an InputError of it for the user:
///
///     model = NAME: TROUBLE; allowed: ALLOWED

#include <string>

#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Reason why a model cannot be fitted to the rows of a survey.
///
/// Both texts are parts of one sentence: without a capital at the start and a full stop at the end.
/// A default-constructed object with empty texts means that nothing is refused.
struct Refusal {
    text::Message trouble;  ///< Cause, without the name of the model.
    std::string allowed;    ///< Remedy: conditions that would make the fit possible.
};

}  // namespace a351::corrector::model
