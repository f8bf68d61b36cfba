// A day that was recorded with a wrong profile becomes the one that was recorded right.

#include "protocol/station/described_again.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <span>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/station/session_description.hpp"
#include "protocol/wire/shipped_profiles.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/archive/data_root.hpp"
#include "tests/unit/station/station_files.hpp"

namespace a351::station {
namespace {

using namespace std::chrono_literals;
using wire::DeviceProfile;

/// Returns a profile like the A352AD10's with passages replaced; each must be there.
const DeviceProfile& profile_with(const test::TemporaryDirectory& directory,
                                  const std::map<std::string, std::string>& replaced) {
    std::string text(std::ranges::find(wire::shipped_profiles(), std::string_view("A352AD10"),
                                       &wire::ShippedProfile::name)
                         ->toml);
    for (const auto& [from, to] : replaced) {
        const auto at = text.find(from);
        REQUIRE(at != std::string::npos);
        text.replace(at, from.size(), to);
    }
    std::ofstream(directory.path() / "mine.toml") << text;
    return wire::load_profile(directory.path() / "mine.toml");
}

/// Writes the data that the daemon records with a profile: two sessions.  Between them the box was
/// moved and an oven was switched on.
void record(const archive::DataRoot& root, const DeviceProfile& profile) {
    std::filesystem::create_directories(root.path() / "metadata");
    std::vector<journal::Chunk> chunks;
    for (const int session : {1, 2}) {
        const Nanoseconds begin = session == 1 ? 0min : 30min;
        journal::JournalStream stream(static_cast<std::uint8_t>(session), begin);
        journal::Header header = journal::header_at(begin, static_cast<std::uint8_t>(session));
        header.profile = profile.name;
        header.filter = profile.filter_coded(6)->name;
        header.declared_rate_hz = 50.0005;
        header.start_up_test = wire::StartUpTest::hard_error;
        stream.chunks.front() = header;
        const std::int64_t first = begin / 20ms;
        stream.frames(first, first + 15'000);
        stream.oven(begin + 5min, 425);
        chunks.insert(chunks.end(), stream.chunks.begin(), stream.chunks.end());

        Description description = station::description();
        describe_session(description, header);
        if (session == 2) {
            description.elevation = Metres(800.0);
            description.has_oven = true;
        }
        const auto file = root.path() / "metadata" / "station.xml";
        const auto xml = session == 1 ? to_station_xml(description)
                                      : extend_station_xml(file, description).value();
        files::replace_file(files::posix_files(), file, std::as_bytes(std::span(xml)));
        events::Event event;
        event.type = "start";
        event.session = header.session;
        event.index = 500;
        event.utc = header.clock.realtime + 10s;
        events::append_event(files::posix_files(), root.path() / "events", event);
    }
    root.write_journal(chunks);
    archive::archive_all(root, chunks);
}

std::map<std::string, std::vector<std::byte>> files_below(const std::filesystem::path& root) {
    std::map<std::string, std::vector<std::byte>> content;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
        if (entry.is_regular_file())
            content[std::filesystem::relative(entry.path(), root)] = test::read_bytes(entry.path());
    return content;
}

}  // namespace

TEST_CASE(
    "a day recorded with a wrong profile and re-timed with the right one is the day recorded "
    "right, byte for byte") {
    const test::TemporaryDirectory profiles;
    const DeviceProfile& wrong = *wire::find_profile("A351");
    // Scales, temperature, delay and the name of the filter differ.
    const DeviceProfile& right =
        profile_with(profiles, {{"fraction_bits = 24", "fraction_bits = 23"},
                                {"slope_degc = -0.0037918", "slope_degc = -0.0000005"},
                                {"data_ready_us = 430", "data_ready_us = 900"},
                                {"\"k512_fc9\"", "\"k512_of_mine\""}});
    const archive::DataRoot recorded_wrong, recorded_right;
    record(recorded_wrong, wrong);
    record(recorded_right, right);
    const test::TemporaryDirectory out;
    auto& files = files::posix_files();
    const auto retime = [&](const archive::DataRoot& root, const char* to,
                            const DeviceProfile* profile = nullptr) {
        archive::retime(files, root.path(), out.path() / to, profile,
                        [&](const auto&... args) { describe_again(files, args...); });
    };
    retime(recorded_right, "right");
    retime(recorded_wrong, "repaired", &right);
    const auto expected = files_below(out.path() / "right");
    const auto repaired = files_below(out.path() / "repaired");
    CHECK(expected.size() > 6);
    for (const auto& [name, bytes] : expected) {
        INFO(name);
        REQUIRE(repaired.contains(name));
        CHECK((repaired.at(name) == bytes));
    }
    CHECK(repaired.size() == expected.size());
    retime(recorded_wrong, "wrong");
    CHECK((files_below(out.path() / "wrong") != expected));
}

TEST_CASE(
    "epochs of a re-timed record begin with their first samples, also if the clock was wrong at an "
    "exchange of the sensor, or not set") {
    struct Case {
        Nanoseconds off{0};  ///< Error of the clock in the first session.
        bool is_set_later = true;
    };
    const Nanoseconds never_set = -journal::kStart.time_since_epoch();
    for (const auto& [off, is_set_later] :
         {Case{3h}, Case{-3h}, Case{never_set}, Case{never_set, false}}) {
        CAPTURE(off.count(), is_set_later);
        const archive::DataRoot root;
        std::vector<journal::Chunk> chunks;
        for (const auto session : {std::uint8_t{1}, std::uint8_t{2}}) {
            const Nanoseconds begin = session == 1 ? 0min : 30min;
            journal::JournalStream stream(session, begin);
            stream.frames(begin / 20ms, begin / 20ms + 6'000);
            auto& header = std::get<journal::Header>(stream.chunks.front());
            header.serial_number = session == 1 ? "T0000001" : "T0000002";
            for (journal::Chunk& chunk : stream.chunks) {
                auto* reading = std::get_if<timing::ClockReading>(&chunk);
                if (std::get_if<journal::Header>(&chunk)) reading = &header.clock;
                if (reading == nullptr || (session == 2 && is_set_later)) continue;
                reading->realtime += off;
                reading->is_synchronised = false;
            }
            chunks.insert(chunks.end(), stream.chunks.begin(), stream.chunks.end());
            if (header.clock.realtime < journal::kStart - 24h && session == 1) continue;
            Description description = station::description();
            describe_session(description, header);
            description.has_oven = true;
            const auto file = root.path() / "metadata" / "station.xml";
            std::filesystem::create_directories(file.parent_path());
            const auto text = std::filesystem::exists(file)
                                  ? extend_station_xml(file, description).value()
                                  : to_station_xml(description);
            files::replace_file(files::posix_files(), file, std::as_bytes(std::span(text)));
        }
        root.write_journal(chunks);
        const test::TemporaryDirectory parent;
        archive::retime(files::posix_files(), root.path(), parent.path() / "out", nullptr,
                        [](const auto&... args) { describe_again(files::posix_files(), args...); });
        const auto epochs = read_station_epochs(parent.path() / "out" / "metadata" / "station.xml");
        if (!is_set_later) {  // No sample has a time, so the file is as it was.
            CHECK(epochs.begin()->second.serial_number == "T0000002");
            continue;
        }
        REQUIRE(epochs.size() == 2);
        CHECK(epochs.begin()->second.serial_number == "T0000001");
        CHECK(std::ranges::count(epochs.begin()->second.channels, archive::kOvenTemperature,
                                 &ChannelScale::code) == 1);
        CHECK(std::chrono::abs(epochs.begin()->first - journal::kStart) < 200ms);
        CHECK(epochs.rbegin()->second.serial_number == "T0000002");
        CHECK(std::chrono::abs(epochs.rbegin()->first - journal::kStart - 30min) < 200ms);
    }
}

TEST_CASE("a profile without the filter of a journal is refused, and nothing is written") {
    const test::TemporaryDirectory profiles;
    const archive::DataRoot root;
    record(root, *wire::find_profile("A351"));
    journal::Header header = journal::header_at(0s);
    const DeviceProfile& other = profile_with(
        profiles, {{"name = \"k512_fc9\", code = 6", "name = \"k512_fc9\", code = 15"}});
    CHECK_THROWS_WITH(archive::recorded_with(other, header),
                      "profile " + other.name +
                          " has no filter with code 6, with which the journal was recorded");
    CHECK_THROWS_AS(
        archive::retime(files::posix_files(), root.path(), profiles.path() / "out", &other),
        InputError);
    CHECK_FALSE(std::filesystem::exists(profiles.path() / "out"));
    header.profile = "unknown";
    CHECK_THROWS_AS(archive::recorded_with(other, header), InputError);
}

}  // namespace a351::station
