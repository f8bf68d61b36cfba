#include "protocol/journal/journal_writer.hpp"

#include <system_error>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_reader.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/files/failing_files.hpp"
#include "tests/unit/journal/segment_fixture.hpp"

using namespace a351::files;

namespace a351::journal {
namespace {

using test::clock_reading;

/// Returns all received bytes of a journal directory, in the order of reading.
std::string received_in(const std::filesystem::path& directory) {
    std::string text;
    Sequence chunks(segment_files(directory));
    while (const auto chunk = chunks.next()) {
        if (const auto* rx = std::get_if<RxChunk>(&*chunk))
            text.append(reinterpret_cast<const char*>(rx->bytes.data()), rx->bytes.size());
    }
    return text;
}

}  // namespace

TEST_CASE("appended chunks are read back in order") {
    const test::TemporaryDirectory directory;
    Writer writer(posix_files(), directory.path() / "journal");
    writer.begin_segment(test::journal_header());
    const auto clock = clock_reading(1001, "2026-03-01T13:00:01Z");
    for (const auto& chunk : test::one_of_each()) {
        if (!std::holds_alternative<Header>(chunk)) writer.append(chunk, clock);
    }
    writer.sync();
    const auto segments = segment_files(directory.path() / "journal");
    REQUIRE(segments.size() == 1);
    CHECK(segments[0].filename() == "00000001_20260301T130000Z.a351j");
    const auto reading = read_all(segments[0]);
    CHECK(reading.kinds == kinds_of(test::one_of_each()));
    CHECK_FALSE(reading.damage);
    CHECK(writer.bytes_written() == std::filesystem::file_size(segments[0]));
}

TEST_CASE("a segment ends after one hour of raw time") {
    const test::TemporaryDirectory directory;
    Writer writer(posix_files(), directory.path());
    writer.begin_segment(test::journal_header());  // Raw time 1000 s.
    const auto rx = test::rx_chunk("a", "b");
    writer.append(rx, clock_reading(4599, "2026-03-01T13:59:59Z"));
    CHECK(segment_files(directory.path()).size() == 1);
    writer.append(rx, clock_reading(4600, "2026-03-01T14:00:00Z"));
    writer.append(rx, clock_reading(8199, "2026-03-01T14:59:59Z"));
    const auto segments = segment_files(directory.path());
    REQUIRE(segments.size() == 2);
    CHECK(segments[1].filename() == "00000002_20260301T140000Z.a351j");
    Reader reader(segments[1]);
    const auto header = reader.next();
    REQUIRE(header);
    CHECK(std::get<Header>(*header).session == test::journal_header().session);
    CHECK(std::get<Header>(*header).clock == clock_reading(4600, "2026-03-01T14:00:00Z"));
}

TEST_CASE("a segment ends when it exceeds 64 MiB") {
    const test::TemporaryDirectory directory;
    Writer writer(posix_files(), directory.path());
    writer.begin_segment(test::journal_header());
    const auto clock = clock_reading(1001, "2026-03-01T13:00:01Z");
    const EventChunk chunk{std::string(kMostPayloadBytes, 'x')};
    for (int i = 0; i < 1025; ++i) writer.append(chunk, clock);
    const auto segments = segment_files(directory.path());
    REQUIRE(segments.size() == 2);
    CHECK(std::filesystem::file_size(segments[0]) >= (64U << 20));
    CHECK(std::filesystem::file_size(segments[0]) < (64U << 20) + 70'000);
}

TEST_CASE(
    "the segment counter continues over restarts and compressed segments, even if time goes back") {
    const test::TemporaryDirectory directory;
    test::write_bytes(directory.path() / "00000416_20270301T120000Z.a351j.zst", {});
    Writer writer(posix_files(), directory.path());
    writer.begin_segment(test::journal_header());
    writer.begin_segment(test::journal_header());
    Writer after_restart(posix_files(), directory.path());
    after_restart.begin_segment(test::journal_header());
    const auto segments = segment_files(directory.path());
    REQUIRE(segments.size() == 4);
    CHECK(segment_number(segments[1]) == 417U);
    CHECK(segment_number(segments[3]) == 419U);
}

TEST_CASE(
    "whichever file operation fails, once or twice, every chunk is read back once and in order") {
    int operations = 0;
    for (int again = 0; again < 6; ++again) {
        for (int fail_at = 1; fail_at == 1 || fail_at <= operations; ++fail_at) {
            const test::TemporaryDirectory directory;
            test::FailingFiles files;
            Writer writer(files, directory.path());
            const int before = files.operations();
            files.fail_at(before + fail_at);
            int failures = 0;
            const auto try_to = [&](auto action) {
                try {
                    action();
                    return true;
                } catch (const std::system_error&) {
                    ++failures;
                    if (failures == 1 && again > 0) files.fail_at(files.operations() + again);
                    return false;
                }
            };
            while (!try_to([&] { writer.begin_segment(test::journal_header()); })) {
            }
            std::string appended;
            for (int i = 0; i < 6; ++i) {
                const std::string text = {char('a' + 2 * i), char('b' + 2 * i)};
                const auto rx = test::rx_chunk(text.substr(0, 1), text.substr(1));
                // The second half comes over an hour later, so that a new segment begins in
                // between.
                const auto clock = clock_reading(i < 3 ? 1001 : 9000, "2026-03-01T15:00:00Z");
                while (!try_to([&] { writer.append(rx, clock); })) {
                }
                appended += text;
                const bool is_synced = i % 2 == 1 && try_to([&] { writer.sync(); });
                if (is_synced) REQUIRE(received_in(directory.path()) == appended);
            }
            while (!try_to([&] { writer.sync(); })) {
            }
            operations = files.operations() - before;
            INFO("operation " << fail_at << ", then " << again << " later");
            REQUIRE(received_in(directory.path()) == appended);
            REQUIRE(failures <= 2);
            REQUIRE(fail_at < 200);
        }
    }
    CHECK(operations >= 10);
}

TEST_CASE(
    "chunks lost by a failed sync are written again, and the new segment says which may be "
    "repeated") {
    const auto clock = clock_reading(1001, "2026-03-01T13:00:01Z");
    const auto rx = [](char c) { return test::rx_chunk({&c, 1}, "."); };
    for (const int kept : {0, 1, 2, 3}) {
        const test::TemporaryDirectory directory;
        test::FailingFiles files;
        Writer writer(files, directory.path());
        writer.begin_segment(test::journal_header());
        writer.append(rx('a'), clock);
        writer.sync();
        const auto segment = segment_files(directory.path()).front();
        std::vector<std::uintmax_t> sizes{std::filesystem::file_size(segment)};
        for (const char c : {'b', 'c', 'd'}) {
            writer.append(rx(c), clock);
            sizes.push_back(std::filesystem::file_size(segment));
        }
        files.fail_at(files.operations() + 1);
        CHECK_THROWS_AS(writer.sync(), std::system_error);
        std::filesystem::resize_file(segment, sizes[static_cast<std::size_t>(kept)]);
        writer.append(rx('e'), clock);
        writer.sync();
        CHECK(received_in(directory.path()) == "a.b.c.d.e.");
        const auto segments = segment_files(directory.path());
        REQUIRE(segments.size() == 2);
        Reader reader(segments[1]);
        CHECK(std::get<Header>(*reader.next()).repeats == RepeatedChunks{1, 2});
    }
}

}  // namespace a351::journal
