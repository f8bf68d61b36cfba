#include "daemon/survey/lasting_word.hpp"

#include <vector>
#include "tests/support/catch.hpp"

namespace a351::daemon::survey {
namespace {

const UtcTime kFirstSecond{std::chrono::hours(400000)};

UtcTime second(int seconds) { return kFirstSecond + std::chrono::seconds(seconds); }

/// Gives one word a second and returns those that are to be logged.
std::vector<WordChange> logged(LastingWord lasting, const std::vector<Word>& words) {
    std::vector<WordChange> changes;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (const auto change = lasting.take(words[i], second(static_cast<int>(i))))
            changes.push_back(*change);
    return changes;
}

TEST_CASE("a word that lasts five seconds is logged once, with its begin", "[signal]") {
    std::vector words(20, Word::keep_off);
    words.resize(24, Word::lift);
    words.resize(40, Word::go);
    CHECK(logged(LastingWord(), words) ==
          std::vector<WordChange>{{Word::keep_off, second(0)}, {Word::go, second(24)}});
}

TEST_CASE("words that change each second are not logged", "[signal]") {
    std::vector words(20, Word::keep_off);
    for (int i = 0; i < 3600; ++i) words.push_back(i % 2 == 0 ? Word::go : Word::keep_off);
    words.resize(words.size() + 5, Word::go);
    words.resize(words.size() + 20, Word::keep_off);
    CHECK(logged(LastingWord(), words) == std::vector<WordChange>{{Word::keep_off, second(0)}});
}

TEST_CASE("a word that was not shown from its begin is logged from when it was", "[signal]") {
    CHECK(logged(LastingWord(second(12)), std::vector(20, Word::go)) ==
          std::vector<WordChange>{{Word::go, second(12)}});
}

}  // namespace
}  // namespace a351::daemon::survey
