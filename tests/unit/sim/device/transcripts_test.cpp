// The conversations of tests/golden/transcripts, on a clock that only the test moves.  The README there
// describes their language.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include "tests/support/catch.hpp"

#include "protocol/text/text_file.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::device;
using namespace std::chrono_literals;

namespace {

using Words = std::vector<std::string>;

const std::filesystem::path kFolder = A351_GOLDEN "/transcripts";

Words words_of(const std::string& line) {
    std::istringstream in(line.substr(0, line.find('#')));
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

/// The host's part of a conversation.  Each failed step names its line.
class Host {
public:
    explicit Host(const Words& options) : machine_(profile(), identity(options), Nanoseconds(0), {}) {}

    void play(const std::filesystem::path& file) {
        std::istringstream lines(text::read_text_file(file));
        for (std::string line; std::getline(lines, line);) {
            Words words = words_of(line);
            if (words.empty() || words[0] == "device") continue;
            CAPTURE(file.filename().string(), line);
            const std::string verb = words[0];
            words.erase(words.begin());
            if (verb == "play") {
                play(kFolder / words.at(0));
            } else if (verb == "restart") {
                machine_.power_cycle(now_);
            } else if (verb == ">") {
                send(words);
            } else if (verb == "<") {
                REQUIRE(matches(words, take(words.size())));
            } else if (verb == "until") {
                repeat(words);
            } else if (verb == "frames") {
                frames(words);
            } else {
                wait(1ms * std::stoi(words.at(0)));
                if (verb == "silence")
                    REQUIRE(hex_of(heard_.bytes) == "");
                else if (verb == "drain")
                    heard_.bytes.clear();
                else
                    REQUIRE(verb == "wait");
            }
        }
    }

private:
    static const wire::DeviceProfile& profile() { return *wire::find_profile("A352AD10"); }
    static MachineIdentity identity(const Words& options) {
        const auto given = [&](const char* name, const char* usual) {
            const auto at = std::ranges::find(options, name);
            return at == options.end() ? std::string(usual) : *std::next(at);
        };
        return {"A352AD10", given("--serial", "00000000"),
                static_cast<std::uint16_t>(std::stoi(given("--firmware", "13"))),
                std::ranges::find(options, "--no-id") == options.end()};
    }

    static bool matches(const Words& pattern, const std::vector<std::byte>& bytes) {
        UNSCOPED_INFO("received: " << hex_of(bytes));
        return std::ranges::equal(pattern, bytes, [](const std::string& token, std::byte byte) {
            return token == "xx" || token == "cc" || token == "ss" || bytes_of(token)[0] == byte;
        });
    }

    void wait(Nanoseconds span) {
        for (const Nanoseconds end = now_ + span; now_ < end;) {
            now_ += 1ms;
            machine_.pass_time(now_);
            stream_.advance_to({UtcTime(now_), now_}, heard_);
        }
    }

    void send(const Words& words) {
        wait(1ms);
        std::string hex;
        for (const std::string& word : words) hex += word + ' ';
        stream_.receive(bytes_of(hex), {UtcTime(now_), now_}, heard_);
    }

    std::vector<std::byte> take(std::size_t size) {
        for (int ms = 0; heard_.bytes.size() < size && ms < 5000; ++ms) wait(1ms);
        REQUIRE(heard_.bytes.size() >= size);
        const auto end = heard_.bytes.begin() + static_cast<std::ptrdiff_t>(size);
        std::vector<std::byte> taken(heard_.bytes.begin(), end);
        heard_.bytes.erase(heard_.bytes.begin(), end);
        return taken;
    }

    void repeat(const Words& words) {
        const auto split = std::ranges::find(words, "<");
        const Words question(words.begin() + 2, split), pattern(split + 1, words.end());
        for (const Nanoseconds end = now_ + 1ms * std::stoi(words[0]);;) {
            send(question);
            const auto answer = take(pattern.size());
            if (matches(pattern, answer)) return;
            REQUIRE(answer.front() == bytes_of(pattern.front())[0]);
            REQUIRE(answer.back() == bytes_of(pattern.back())[0]);
            REQUIRE(now_ < end);
        }
    }

    void frames(const Words& words) {
        const Words pattern(words.begin() + 3, words.end());
        const auto at = [&](const char* token) {
            return static_cast<std::size_t>(std::ranges::find(pattern, token) - pattern.begin());
        };
        std::optional<int> before;
        for (int i = 0; i < std::stoi(words[0]); ++i) {
            const auto frame = take(pattern.size());
            REQUIRE(matches(pattern, frame));
            const auto word = [&frame](std::size_t k) {
                return std::to_integer<int>(frame[k]) * 256 + std::to_integer<int>(frame[k + 1]);
            };
            if (at("ss") < pattern.size()) {
                int sum = 0;
                for (std::size_t k = 1; k < at("ss"); k += 2) sum += word(k);
                REQUIRE(sum % 65536 == word(at("ss")));
            }
            if (at("cc") == pattern.size()) continue;
            if (before) REQUIRE((word(at("cc")) - *before + 65536) % 65536 == std::stoi(words[2]));
            before = word(at("cc"));
        }
    }

    /// At rest: 1 g on z.
    GridSource source_{50, [](std::int64_t) {
                           return signal::SensorSample{{0, 0, kOneG}, -1981};
                       }};
    RegisterMachine machine_;
    DeviceStream stream_{source_, machine_};
    Collected heard_;
    Nanoseconds now_{0};
};

}  // namespace

TEST_CASE("the emulator answers as in the transcripts from the data sheet and the maker's software") {
    int played = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.path().extension() != ".txt") continue;
        std::istringstream lines(text::read_text_file(entry.path()));
        Words options;
        for (std::string line; options.empty() && std::getline(lines, line);)
            options = words_of(line);
        Host(options).play(entry.path());
        ++played;
    }
    CHECK(played == 20);
}
