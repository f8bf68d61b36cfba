#include "daemon/store/store.hpp"

#include <fmt/core.h>

#include <fstream>

#include "protocol/text/text_file.hpp"
#include "tests/unit/daemon/stepped_rig.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;

TEST_CASE_METHOD(Rig, "everything read is in the journal byte for byte and in the archive once") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(kFrames);
    CHECK(store.stop());

    const JournalContent journal = read_journal(root);
    CHECK(journal.bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(kFrames));
    const Status status = status_of(store);
    CHECK(status.received == kFrames - 1);
    CHECK(status.journaled == kFrames - 1);
    CHECK(status.archived == kFrames - 1);
    REQUIRE(journal.marks.size() == 1);
    CHECK(journal.marks[0].session.bytes[0] == 42);
    CHECK(std::filesystem::exists(root / "metadata" / "station.xml"));
}

TEST_CASE_METHOD(Rig, "an event is in the journal and in the event log when commit returns") {
    Store store(files, options(), clock, reads);
    store.start();
    events::Event event = note_at(clock.now(), "before the first session");
    store.commit(event);
    CHECK(events::read_events(root / "events").events.size() == 1);

    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return store.latest().has_value(); }));
    event.details["note"] = "wind";
    store.commit(event);
    const JournalContent journal = read_journal(root);
    REQUIRE(journal.events.size() == 1);
    CHECK(journal.events[0] == events::to_json(event));
    CHECK(events::read_events(root / "events").events.size() == 2);
}

TEST_CASE_METHOD(Rig,
                 "after a sleep the journal has the reader's clock reading before later bytes") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(10);
    timing::ClockReading woken = clock.read();
    woken.raw += std::chrono::hours(2);  // A segment ends meanwhile.
    woken.boottime += std::chrono::hours(10);
    REQUIRE(reads.push_woken(woken));
    feed(10);
    CHECK(store.stop());

    std::size_t bytes_before = 0;
    std::optional<journal::Header> header;
    bool is_written = false;
    journal::Sequence chunks(journal::segment_files(root / "journal"));
    for (auto chunk = chunks.next(); chunk && !is_written; chunk = chunks.next()) {
        if (const auto* rx = std::get_if<journal::RxChunk>(&*chunk))
            bytes_before += rx->bytes.size();
        if (const auto* next = std::get_if<journal::Header>(&*chunk)) header = *next;
        if (const auto* reading = std::get_if<timing::ClockReading>(&*chunk))
            is_written = *reading == woken;
    }
    CHECK(is_written);
    CHECK(bytes_before == bytes.size() / 2);
    REQUIRE(header);
    CHECK(header->clock == woken);
}

TEST_CASE_METHOD(RecordingRig, "a step of the host's clock is in the event log and in the status") {
    timing::ClockReading reading = clock.read();
    const auto push_seconds = [&](int count) {
        for (int i = 0; i < count; ++i) {
            reading.raw += std::chrono::seconds(1);
            reading.boottime += std::chrono::seconds(1);
            reading.realtime += std::chrono::seconds(1);
            reading.is_synchronised = true;
            REQUIRE(reads.push_woken(reading));
        }
    };
    push_seconds(600);
    reading.realtime -= std::chrono::seconds(80);
    push_seconds(7200);
    CHECK(store.stop());

    std::vector<events::Event> steps = events::read_events(root / "events").events;
    REQUIRE(steps.size() == 1);
    CHECK(steps[0].type == "clock_step");
    CHECK(std::stod(steps[0].details.at("by_s")) == Approx(-80.0).margin(0.01));
    const auto step = status_of(store).clock_step;
    REQUIRE(step);
    CHECK(step->after == steps[0].utc);
    CHECK(steps[0].details.at("clock_before") == to_rfc3339(step->before, 3));
}

TEST_CASE_METHOD(
    RecordingRig,
    "another result of the start-up test is in the event log, and that of another sensor") {
    using Test = wire::StartUpTest;
    struct Begun {
        Test test;
        const char* unit;
        bool is_logged;
    };
    const Begun sessions[] = {
        {Test::hard_error, "00000042", true}, {Test::hard_error, "00000042", false},
        {Test::passed, "00000042", true},     {Test::hard_error, "00000777", true},
        {Test::hard_error, "00000042", true}, {Test::passed, "00000777", true},
        {Test::passed, "00000042", true},     {Test::passed, "00000042", false}};
    std::vector<std::string> expected;
    std::uint8_t session = 100;
    for (const auto& [test, unit, is_logged] : sessions) {
        start_up_test = test;
        serial_number = unit;
        begin_session(++session);
        if (is_logged)
            expected.push_back(fmt::format("{} {} {}", session, wire::to_text(test), unit));
    }
    CHECK(store.stop());
    std::vector<std::string> logged;
    for (const events::Event& event : events::read_events(root / "events").events)
        if (event.type == "start_up_test")
            logged.push_back(fmt::format("{} {} {}", event.session->bytes[0],
                                         event.details.at("result"),
                                         event.details.at("serial_number")));
    CHECK(logged == expected);
}

TEST_CASE_METHOD(Rig,
                 "another sensor is reported from the last sample of the one before, and warned of "
                 "within a survey day only") {
    std::vector<events::Event> reported;
    std::uint8_t session = 0;
    const auto run = [&](const char* serial, UtcTime day_end) {
        Options with_call = options();
        with_call.other_unit = [&](const events::Event& event) { reported.push_back(event); };
        Store store(files, with_call, clock, reads);
        store.set_day_end(day_end);
        store.start();
        serial_number = serial;
        begin_session(++session);
        feed(100);
        CHECK(eventually([&] { return status_of(store).received == 99; }));
        CHECK_FALSE(status_of(store).started_again);
        begin_session(++session);
        feed(100);
        CHECK(eventually([&] {
            const Status status = status_of(store);
            return status.session == journal::SessionId{{session}}.to_hex() &&
                   status.received == 99;
        }));
        CHECK(store.stop());
        CHECK(status_of(store).started_again);
        return status_of(store).unit_change;
    };
    CHECK_FALSE(run("00000042", UtcTime::max()));
    CHECK(reported.empty());
    const auto change = run("00000777", UtcTime::max());  // exchanged while the daemon did not run
    REQUIRE(change);
    CHECK(change->before == "00000042");
    CHECK(change->after == "00000777");
    REQUIRE(reported.size() == 1);
    CHECK(reported[0].type == "other_unit");
    CHECK(reported[0].details.at("before") == "00000042");
    CHECK(reported[0].details.at("serial_number") == "00000777");
    CHECK(reported[0].session->bytes[0] == 2);
    CHECK(reported[0].index == 99);
    CHECK_FALSE(run("00000042", clock.now() - std::chrono::hours(1)));  // on the next morning
    CHECK(reported.size() == 2);
    for (const events::Event& event : events::read_events(root / "events").events)
        CHECK(event.type == "start_up_test");  // Occupations notes the exchange.
}

TEST_CASE("after the journal is drained only chunks posted by the archive are written to it") {
    SteppedRig rig;
    SpaceReserve reserve(rig.files, rig.root / "state" / "reserve", 0);
    ChunkQueue decoded;
    Progress progress;
    JournalThread journal(rig.files, rig.root, rig.reads.capacity(), progress, reserve,
                          rig.options().time);
    ChunkMaker chunk_maker(rig.clock, rig.reads, journal, decoded, rig.options().time);
    rig.begin_session();
    rig.feed(10);
    rig.pass(std::chrono::seconds(5));
    chunk_maker.drain();
    journal.drain();
    rig.pass(std::chrono::seconds(5));  // Time that the archive takes to end.
    journal.push(0, journal::MarkChunk{});
    CHECK(journal.finish());

    std::size_t handed_over = 0;
    NumberedChunk next;
    while (decoded.try_pop(next)) ++handed_over;
    std::vector<journal::Chunk> journaled;
    journal::Sequence chunks(journal::segment_files(rig.root / "journal"));
    while (auto chunk = chunks.next()) journaled.push_back(std::move(*chunk));
    REQUIRE(journaled.size() == handed_over + 1);
    CHECK(std::holds_alternative<journal::MarkChunk>(journaled.back()));
}

TEST_CASE_METHOD(Rig, "the store finds the sample that belongs to a time") {
    Store store(files, options(), clock, reads);
    store.start();
    CHECK_FALSE(store.latest());
    begin_session();
    feed(kFrames);
    REQUIRE(eventually([&] { return status_of(store).received == kFrames - 1; }));
    const auto latest = store.latest();
    REQUIRE(latest);
    CHECK(latest->index == kFrames - 1);
    CHECK(latest->session.bytes[0] == 42);
    const auto earlier = store.at(latest->utc - 500 * kPeriod);
    REQUIRE(earlier);
    // Times are fixed in steps of a second that may differ by 0.2 ms, a hundredth of a sample.
    CHECK(std::abs(earlier->index - (kFrames - 1 - 500)) <= 1);
    CHECK_FALSE(store.at(latest->utc + kPeriod));
    CHECK_FALSE(store.at(latest->utc - (kFrames + 10) * kPeriod));
    CHECK(store.signal_since(latest->session, latest->index - 500) == 500 * kPeriod);

    begin_session(101);
    // The new session has no sample yet: the latest is that of the old one.
    REQUIRE(eventually([&] { return status_of(store).session != latest->session.to_hex(); }));
    REQUIRE(store.latest());
    CHECK(store.latest()->session == latest->session);
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).received == 99; }));
    REQUIRE(store.at(earlier->utc));
    CHECK(store.at(earlier->utc)->session == latest->session);
    CHECK(store.at(earlier->utc)->index == earlier->index);
    CHECK(store.signal_since(latest->session, latest->index - 500) == 600 * kPeriod);
    CHECK(store.signal_since({}, 0) == (kFrames + 100) * kPeriod);  // a session that is forgotten
    CHECK(store.signal_since(store.latest()->session, 0) == 99 * kPeriod);
}

TEST_CASE_METHOD(Rig, "a data root accepts one daemon at a time") {
    {
        const Store store(files, options(), clock, reads);
        CHECK_THROWS_AS(Store(files, options(), clock, reads), DataRootLocked);
        std::filesystem::remove_all(root / "state");
        CHECK_THROWS_AS(Store(files, options(), clock, reads), DataRootLocked);
    }
    CHECK_NOTHROW(Store(files, options(), clock, reads));
}

TEST_CASE_METHOD(Rig, "a data root that is moved or deleted while it is used is a fault at once") {
    Store store(files, options(), clock, reads);
    const auto is_moved = [&] {
        status::Status status;
        store.fill(status);
        return std::ranges::any_of(status.reasons, [](const text::Message& reason) {
            return reason.english().starts_with("storage.root leads to another folder");
        });
    };
    CHECK_FALSE(is_moved());
    std::filesystem::rename(root, root.string() + "-1");
    CHECK(is_moved());
    std::filesystem::create_directory(root);  // another folder of this name
    CHECK(is_moved());
    CHECK_THROWS_AS(store.commit({}), std::system_error);
    CHECK(std::filesystem::is_empty(root));
    std::filesystem::remove(root);
    std::filesystem::rename(root.string() + "-1", root);
    CHECK_FALSE(is_moved());
}

TEST_CASE_METHOD(Rig, "a link in place of a folder of the data root is refused at the start") {
    const auto elsewhere = directory.path() / "elsewhere";
    std::filesystem::create_directory(elsewhere);
    const auto below = files::files_below(root);
    for (const char* name : {"journal", "archive", "metadata", "events", "state"}) {
        CAPTURE(name);
        std::filesystem::remove_all(root);
        std::filesystem::create_directories(root);
        std::filesystem::create_directory_symlink(elsewhere, root / name);
        CHECK_THROWS_AS(Store(*below, options(), clock, reads), std::system_error);
        CHECK(std::filesystem::is_empty(elsewhere));
    }
}

TEST_CASE_METHOD(Rig, "station metadata are replaced only if they describe something else") {
    station::Description station = options().station;
    station.start = clock.now();
    station.serial_number = "00000042";
    const auto described = [&] {
        CHECK_FALSE(describe_station(files, root, station));
        return text::read_text_file(root / "metadata" / "station.xml");
    };
    files.create_directories(root / "metadata");
    const auto first_written = described();
    station.start += std::chrono::hours(1);
    CHECK(described() == first_written);
    station.serial_number = "00000043";
    CHECK_THAT(described(), ContainsSubstring("<SerialNumber>00000042<") &&
                                ContainsSubstring("<SerialNumber>00000043<"));
}

TEST_CASE_METHOD(Rig, "damaged station metadata are set aside and written again") {
    station::Description station = options().station;
    station.start = clock.now();
    files.create_directories(root / "metadata");
    const auto file = root / "metadata" / "station.xml";
    describe_station(files, root, station);
    const auto whole = text::read_text_file(file);
    const auto write = [&](const std::string& content) {
        std::ofstream(file, std::ios::binary) << content;
    };
    for (const std::size_t size : {std::size_t{0}, whole.size() / 3, whole.size() - 20}) {
        INFO("cut to " << size);
        write(whole.substr(0, size));
        const auto trouble = describe_station(files, root, station);
        REQUIRE(trouble);
        CHECK_THAT(*trouble, ContainsSubstring("station.xml: "));
        CHECK(text::read_text_file(file) == whole);
    }
    CHECK(text::read_text_file(root / "metadata" / "station.xml.damaged").empty());
    CHECK(text::read_text_file(root / "metadata" / "station.xml.damaged.3") ==
          whole.substr(0, whole.size() - 20));
    // Damage found at the start of a session is reported.
    write("no xml");
    Store store(files, options(), clock, reads);
    store.start();
    begin_session();
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).received == 99; }));
    CHECK(store.stop());
    CHECK(has_reason(status_of(store), "metadata: "));
}
