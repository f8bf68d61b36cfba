#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "daemon/survey/signal.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::survey {

/// Time that a word must last before it is logged.  Reason: each event is synced, and a word may
/// change with each value of the live series.
inline constexpr Nanoseconds kLeastLogged = std::chrono::seconds(5);

/// A word that is worth an event.
struct WordChange {
    Word word = Word::no_data;
    UtcTime since;

    bool operator==(const WordChange&) const = default;
};

/// Chooses the words that are worth an event: each that is another one than the last event and has
/// lasted kLeastLogged.  All times are those of the data.
class LastingWord {
public:
    /// @param from  no change is earlier than this
    explicit LastingWord(UtcTime from = {}) : from_(from) {}

    /// Takes the word at `time`; times increase.
    /// @return the change, once, if it is to be logged
    [[nodiscard]] std::optional<WordChange> take(Word word, UtcTime time) {
        if (word != word_) since_ = time;
        word_ = word;
        if (word == logged_ || time - since_ < kLeastLogged) return std::nullopt;
        logged_ = word;
        return WordChange{word, std::max(since_, from_)};
    }

private:
    UtcTime from_;
    UtcTime since_;
    std::optional<Word> word_, logged_;
};

}  // namespace a351::daemon::survey
