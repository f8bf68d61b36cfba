#include "daemon/page/live_stream.hpp"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/raw_viewer.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::live;
using namespace a351::daemon::page;
using namespace a351::daemon::status;
using nlohmann::json;
using std::chrono::milliseconds;

namespace {

// A sanitizer makes the reader too slow for some tests, and it keeps freed memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

/// Returns the next block, after a check that it has the form and counts of numbered samples.
ReadBlock next_block(const RawViewer& viewer) {
    const auto frame = viewer.next(RawViewer::binary);
    REQUIRE(frame);
    const ReadBlock block(frame->payload);
    REQUIRE(block.is_whole);
    REQUIRE(block.version == 1);
    REQUIRE(block.kind == 1);
    REQUIRE(block.mask == 0x0F);
    REQUIRE(block.count > 0);
    std::int64_t wrong = 0;
    for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel) {
        for (std::uint32_t i = 0; i < block.count; ++i) {
            wrong +=
                block.counts[channel][i] != numbered_sample(block.first_index + i).counts[channel];
        }
    }
    CHECK(wrong == 0);
    return block;
}

/// Reads blocks until the sample before `last` has come.  @return the number of samples
std::int64_t read_up_to(const RawViewer& viewer, std::int64_t first, std::int64_t last) {
    std::int64_t expected = first;
    while (expected < last) {
        const auto block = next_block(viewer);
        REQUIRE(block.first_index == expected);
        expected = block.end_index();
    }
    CHECK(expected == last);
    return expected - first;
}

/// Adds numbered samples from `first` to `last` - 1, one per `step`.  @return `last`
std::int64_t take_every(milliseconds step, Served& served, std::int64_t first, std::int64_t last) {
    for (std::int64_t index = first; index < last; ++index) {
        auto sample = numbered_sample(index);
        sample.time = kMorning + index * step;
        served.live.take(sample);
    }
    return last;
}

double resident_mb() {
    std::size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double metric(const Served& served, const std::string& name) {
    const auto text = served.answer(served.get("/metrics"));
    const auto at = text.find('\n' + name + ' ');
    REQUIRE(at != std::string::npos);
    return std::stod(text.substr(at + name.size() + 2));
}

}  // namespace

TEST_CASE("a stream begins with the status and past samples, and continues without a gap") {
    Served served;
    take_samples(served.live, 0, 1000);
    const RawViewer viewer(served);
    REQUIRE(viewer.status() == 101);
    const auto first = viewer.next();
    REQUIRE(first);
    CHECK(first->kind == RawViewer::text);
    const auto status = json::parse(first->payload);
    CHECK(status.size() == 2);
    CHECK(status.at("status").at("level") == "warning");
    CHECK(status.at("rows").at(0).at("label") == "state");
    CHECK(status.at("rows").at(0).at("text").get<std::string>().starts_with("warning: No values"));

    const auto past = next_block(viewer);
    CHECK(past.first_index == 0);
    CHECK(past.count == 1000);
    CHECK(past.interval_ms == Approx(20.0).epsilon(1e-12));
    CHECK(past.time_ms ==
          std::chrono::duration<double, std::milli>(instant_of(0).time_since_epoch()).count());
    for (std::int64_t at = 1000; at < 1700; at += 7) {
        take_samples(served.live, at, at + 7);
        std::this_thread::sleep_for(milliseconds(3));
    }
    CHECK(read_up_to(viewer, 1000, 1700) == 700);
}

TEST_CASE(
    "a stream begins with the samples of the last 60 s, in several messages if they are many") {
    Served served({}, 1000);
    take_every(milliseconds(1), served, 0, 80'000);
    const RawViewer viewer(served);
    int messages = 0;
    for (std::int64_t expected = 20'000; expected < 80'000; ++messages) {
        const auto frame = viewer.next(RawViewer::binary);
        REQUIRE(frame);
        CHECK(frame->payload.size() <= 64 * 1024);
        const ReadBlock block(frame->payload);
        REQUIRE(block.first_index == expected);
        expected = block.end_index();
    }
    CHECK(messages == 15);
}

TEST_CASE("a new message begins after a gap") {
    Served served;
    take_samples(served.live, 0, 10);
    take_samples(served.live, 13, 20);
    const RawViewer viewer(served);
    CHECK(read_up_to(viewer, 0, 10) == 10);
    const auto behind = next_block(viewer);
    CHECK(behind.first_index == 13);
    CHECK(behind.count == 7);
    CHECK(behind.time_ms ==
          std::chrono::duration<double, std::milli>(instant_of(13).time_since_epoch()).count());
    take_samples(served.live, 40, 50);
    CHECK(next_block(viewer).first_index == 40);
}

TEST_CASE("viewers that connect at any time get every sample once") {
    Served served;
    std::atomic<bool> is_done{false};
    std::atomic<int> bad{0};
    std::thread sensor([&] {
        for (std::int64_t at = 0; at < 1500; ++at) {
            take_samples(served.live, at, at + 1);
            std::this_thread::sleep_for(milliseconds(1));
        }
        is_done = true;
    });
    std::vector<std::thread> viewers;
    for (int i = 0; i < 8; ++i) {
        viewers.emplace_back([&, i] {
            std::this_thread::sleep_for(milliseconds(97 * i));
            const RawViewer viewer(served);
            std::int64_t expected = 0;
            while (expected < 1500) {
                const auto frame = viewer.next(RawViewer::binary);
                const ReadBlock block(frame ? frame->payload : std::string());
                if (!block.is_whole || block.first_index != expected) break;
                expected = block.end_index();
            }
            if (expected != 1500) ++bad;
        });
    }
    for (auto& viewer : viewers) viewer.join();
    sensor.join();
    CHECK(is_done);
    CHECK(bad == 0);
}

TEST_CASE("the status comes once a second, and at once when the level changes") {
    Served served;
    const RawViewer viewer(served);
    REQUIRE(viewer.next(RawViewer::text));
    REQUIRE(viewer.next(RawViewer::text));
    const auto begin = std::chrono::steady_clock::now();
    REQUIRE(viewer.next(RawViewer::text));
    REQUIRE(viewer.next(RawViewer::text));
    const auto two = std::chrono::steady_clock::now() - begin;
    CHECK(two > milliseconds(1500));
    CHECK(two < milliseconds(3500));

    const auto changed = std::chrono::steady_clock::now();
    served.set_level(Status::Level::fault);
    const auto status = viewer.next(RawViewer::text);
    const auto after = std::chrono::steady_clock::now() - changed;
    REQUIRE(status);
    CHECK(json::parse(status->payload).at("status").at("level") == "fault");
    CHECK(after < milliseconds(700));
    std::cout << "a change was reported after "
              << std::chrono::duration<double, std::milli>(after).count() << " ms\n";
}

TEST_CASE("samples reach a viewer soon after they were taken") {
    Served served;
    const RawViewer viewer(served);
    double largest_ms = 0.0;
    for (std::int64_t at = 0; at < 20; ++at) {
        const auto taken = std::chrono::steady_clock::now();
        take_samples(served.live, at, at + 1);
        CHECK(next_block(viewer).first_index == at);
        const auto after = std::chrono::steady_clock::now() - taken;
        largest_ms = std::max(largest_ms, std::chrono::duration<double, std::milli>(after).count());
    }
    std::cout << "samples came after " << largest_ms << " ms at most\n";
    CHECK(largest_ms < 500.0);
}

TEST_CASE("a viewer that does not read misses messages, delays nobody and costs little memory") {
    if (kIsSanitized) {
        std::cout << "skipped: a sanitizer makes the reader too slow\n";
        return;
    }
    constexpr int kRate = 200;
    constexpr milliseconds kInterval(5);
    constexpr std::int64_t kBurst = 16'000;  // 256 KiB in four messages; the record keeps 18 000.
    constexpr int kBursts = 40;              // 10 MB.
    ServerOptions options;
    options.stream_patience = std::chrono::minutes(1);
    Served served(options, kRate);
    const RawViewer reader(served), stuck(served);
    std::int64_t taken = 0, read = 0;
    double before_mb = 0.0;
    for (int i = 0; i < kBursts; ++i) {
        if (i == 8) before_mb = resident_mb();  // Record and messages are full by then.
        taken = take_every(kInterval, served, taken, taken + kBurst);
        read += read_up_to(reader, read, taken);
    }
    const double grown_mb = resident_mb() - before_mb;
    const double dropped = metric(served, "a351_page_messages_dropped_total");
    std::cout << read << " samples to the one that reads; " << dropped
              << " messages not sent to the other; memory grew by " << grown_mb << " MB\n";
    CHECK(read == kBursts * kBurst);
    CHECK(metric(served, "a351_page_streams") == 2);
    CHECK(dropped == 0);  // Missed messages are counted when it reads again.
    CHECK(grown_mb < 4.0);

    // It continues after the messages that it missed, up to the end.
    std::int64_t behind = 0;
    while (behind < taken) {
        const auto block = next_block(stuck);
        REQUIRE(block.first_index >= behind);
        behind = block.end_index();
    }
    CHECK(metric(served, "a351_page_messages_dropped_total") > 100);
}

TEST_CASE("viewers that read nothing or answer no ping are disconnected") {
    if (kIsSanitized) {
        std::cout << "skipped: a sanitizer makes the reader too slow\n";
        return;
    }
    ServerOptions options;
    options.stream_patience = milliseconds(500);
    Served served(options, 1000);
    const RawViewer reader(served);
    const RawViewer mute(served);    // Answers no ping.
    const RawViewer talker(served);  // Sends without ever reading.
    std::int64_t at = 0;
    const auto begin = std::chrono::steady_clock::now();
    double streams = 3;
    while (streams > 1 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(30)) {
        talker.send(RawViewer::text, "hm");
        take_every(milliseconds(1), served, at, at + 10'000);
        at += read_up_to(reader, at, at + 10'000);
        streams = metric(served, "a351_page_streams");
    }
    std::cout << "disconnected after "
              << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()
              << " s\n";
    CHECK(streams == 1);
    CHECK(reader.next());
}

TEST_CASE("a viewer that disconnects without notice, or a stop of the server, does no harm") {
    Served served;
    for (int i = 0; i < 50; ++i) {
        const RawViewer viewer(served);
        if (i % 2 == 0) CHECK(viewer.next());
        take_samples(served.live, 10 * i, 10 * (i + 1));
    }
    const RawViewer last(served);
    CHECK(last.next());
    CHECK(served.is_well());
    served.server.stop();
}

TEST_CASE("a failing status is counted and does not stop the samples") {
    Served served;
    served.is_failing = true;
    take_samples(served.live, 0, 100);
    const RawViewer viewer(served);
    const auto first = viewer.next();
    REQUIRE(first);
    CHECK(first->kind == RawViewer::binary);
    take_samples(served.live, 100, 200);
    CHECK(read_up_to(viewer, 100, 200) == 100);
    CHECK(status_of(served.answer(served.get("/metrics"))) == 500);
    served.is_failing = false;
    const auto status = viewer.next(RawViewer::text);
    REQUIRE(status);
    CHECK(metric(served, "a351_page_failures_total") > 0);
}
