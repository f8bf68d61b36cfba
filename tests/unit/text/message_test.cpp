#include "protocol/text/message.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

namespace text = a351::text;
using text::Language, text::message;
using Sentence = text::Message;

namespace {

const Language kJapanese = *text::parse_language("ja");

}  // namespace

TEST_CASE("a message is its English text, and its translation in another language") {
    const Sentence one = message("{} is later than the last sample, {}", "10:00", "09:59");
    CHECK(one == "10:00 is later than the last sample, 09:59");
    CHECK(one.in(Language::english) == one.english());
    CHECK(one.in(kJapanese) == "10:00 は最新サンプル 09:59 より後です");
    // Arguments keep their formats, and change places with the translation.
    const Sentence set = message("the laptop's clock was set {} by {:.1f} s, from {} to {}",
                                 message("back"), 2.345, "A", "B");
    CHECK(set == "the laptop's clock was set back by 2.3 s, from A to B");
    CHECK(set.in(kJapanese) == "PC の時計が A から B へ、2.3 秒戻して設定されました");
    // Parts are translated each by itself, and names not at all.
    const Sentence both = message("started {} at {}", "stable", "10:00") + "; " + message("stable");
    CHECK(both == "started stable at 10:00; stable");
    CHECK(both.in(kJapanese) == "stable を 10:00 に開始しました; 安定");
}

TEST_CASE("a message read from JSON is the one that was written") {
    const Sentence one = message("restored {}", message("{} (stay {})", "No.1", 2)) + "!";
    const Sentence said = text::parse_message(one.to_json(), "");
    CHECK(said == one);
    CHECK(said.in(kJapanese) == one.in(kJapanese));
    CHECK(text::parse_message(nlohmann::json(3), "plain") == "plain");
    CHECK(text::parse_message(nlohmann::json::parse("[[4]]"), "plain") == "plain");
}

TEST_CASE(
    "each language has a code, a name and a catalogue of its own, and English where it has no "
    "text") {
    CHECK(text::translated("no such text", kJapanese) == "no such text");
    CHECK(text::translated("", kJapanese).empty());
    CHECK(text::catalogue(Language::english).empty());
    CHECK(text::catalogue(kJapanese).size() > 100);
    CHECK(text::name_of(Language::english) == "English");
    CHECK(text::name_of(kJapanese) == "日本語");
    for (const Language& one : text::other_languages()) {
        CAPTURE(one.code);
        CHECK(text::parse_language(std::string(one.code) + "_XX.UTF-8") == one);
        CHECK(text::catalogue(one).size() == text::catalogue(kJapanese).size());
        CHECK(text::name_of(one) != "English");
    }
    CHECK_FALSE(text::parse_language("xx"));
}

TEST_CASE("the language follows A351_LANG, then the locale's variables") {
    for (const char* const name : {"A351_LANG", "LC_ALL", "LC_MESSAGES", "LANG"}) unsetenv(name);
    CHECK(text::language_of_environment() == Language::english);
    setenv("LANG", "ja_JP.UTF-8", 1);
    CHECK(text::language_of_environment() == kJapanese);
    setenv("LC_ALL", "C.UTF-8", 1);
    CHECK(text::language_of_environment() == Language::english);
    setenv("A351_LANG", "ja", 1);
    CHECK(text::language_of_environment() == kJapanese);
    setenv("A351_LANG", "xx", 1);
    CHECK(text::language_of_environment() == Language::english);
    for (const char* const name : {"A351_LANG", "LC_ALL", "LANG"}) unsetenv(name);
}
