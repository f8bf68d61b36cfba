#include "tests/support/long_tests.hpp"
#include "tests/unit/daemon/stepped_rig.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;
using std::chrono::seconds;
using test::Fault;

namespace {

// Time of a frame on the wire: 24 bytes of 10 bits at 460 800 Bd.
constexpr Nanoseconds kWire{24LL * 10 * 1'000'000'000 / 460'800};

/// A run of 60 s with two events, through a store whose files fail as requested.  check() recovers
/// what it left.
class Minute : public SteppedRig {
public:
    explicit Minute(const Fault& fault) : kind_(fault.kind) {
        {
            Store store(failing_, options(), clock, reads);
            failing_.set(fault);
            begin_session();
            advance(store, seconds(20));
            note_event(store, "a third of it");
            advance(store, seconds(20));
            note_event(store, "two thirds of it");
            advance(store, seconds(20));
            published_ = status_of(store).journaled.value_or(-1);
            uncertainty_ = status_of(store).timing_uncertainty.value_or(Nanoseconds(0));
            std::filesystem::copy(root, killed_, std::filesystem::copy_options::recursive);
            is_stopped_well_ = store.stop();
            published_at_stop_ = status_of(store).journaled.value_or(-1);
            const auto counters = status_of(store).more_counters;
            faults_counted_ = counters.at("journal_faults") + counters.at("archive_faults") +
                              counters.at("events_refused") + counters.at("reserve_given_up");
        }
        operations_ = failing_.operations();
        failing_.set({});
    }

    /// Checks that no sample reported as journaled is lost, duplicated or changed.
    void check(const Fault& fault) {
        CAPTURE(fault.at, fault.lasts, static_cast<int>(fault.kind));
        check_root(killed_, published_);
        if (is_stopped_well_) CHECK(published_at_stop_ == fed - 1);
        const int archived = check_root(root, published_at_stop_);
        if (!fault.lasts) CHECK(archived == fed);
    }

    [[nodiscard]] int operations() const noexcept { return operations_; }
    [[nodiscard]] bool is_fault_counted() const noexcept { return faults_counted_ > 0; }

private:
    void note_event(Store& store, const std::string& text) {
        const events::Event event = note_at(utc, text);
        if (commit(store, event)) acknowledged_.push_back(events::to_json(event));
    }

    /// Recovers `found` and checks it.  @return the smallest sample count of any archived channel
    int check_root(const std::filesystem::path& found, std::int64_t published) {
        store::Options again = options();
        again.root = found;
        test::FailingFiles unharmed;
        const auto report = recover(unharmed, again, clock);
        // A journal that lost data in a failed sync may lack samples that the archive has.
        if (kind_ != Fault::Kind::sync) CHECK(report.records_conflicting == 0);
        int archived = fed;
        const std::array<const char*, 4> channels{"BN1", "BN2", "BNZ", "BK1"};
        for (std::size_t i = 0; i < channels.size(); ++i)
            archived = std::min(archived, check_channel(found, channels.at(i), i));
        CHECK(archived > published);
        check_events(found);
        return archived;
    }

    int check_channel(const std::filesystem::path& found, const char* channel, std::size_t place) {
        const auto data =
            archive::read_channel(found / "archive", {}, channel, utc - std::chrono::hours(1), utc);
        CHECK(data.damage.empty());
        int count = 0;
        bool is_same = true;
        Nanoseconds worst{0};
        for (const archive::Segment& segment : data.segments) {
            for (std::size_t i = 0; i < segment.counts.size(); ++i, ++count) {
                is_same = is_same && segment.counts[i] == counts(count, place);
                const UtcTime truth = arrival(count) - kWire - group_delay();
                worst = std::max(worst, Nanoseconds(std::chrono::abs(segment.time_of(i) - truth)));
            }
        }
        CHECK(is_same);
        CHECK(samples_in_records(found, channel) == static_cast<std::size_t>(count));
        if (count > 0) CHECK(worst <= uncertainty_);
        return count;
    }

    void check_events(const std::filesystem::path& found) {
        const events::EventLog log = events::read_events(found / "events");
        std::vector<std::string> kept;
        for (const events::Event& event : log.events) kept.push_back(events::to_json(event));
        for (const std::string& event : acknowledged_)
            CHECK(std::count(kept.begin(), kept.end(), event) == 1);
        const auto journaled = read_journal(found).events;
        for (const std::string& event : journaled)
            CHECK(std::count(journaled.begin(), journaled.end(), event) == 1);
    }

    static Nanoseconds group_delay() {
        const wire::DeviceProfile* profile = wire::find_profile("A351");
        return profile->group_delay(*profile->filter_named("k512_fc9"));
    }

    Fault::Kind kind_;
    test::FailingFiles failing_;
    std::filesystem::path killed_ = directory.path() / "killed";
    std::int64_t published_ = -1, published_at_stop_ = -1;
    Nanoseconds uncertainty_{0};
    bool is_stopped_well_ = false;
    std::uint64_t faults_counted_ = 0;
    int operations_ = 0;
    std::vector<std::string> acknowledged_;
};

// Step between tried operations in the short form.  It is prime, so that the tries meet operations
// of every kind.  A sanitizer takes 30 times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kShortStride = 97;
#else
constexpr int kShortStride = 19;
#endif

}  // namespace

TEST_CASE("a minute without faults needs the same number of file operations each time") {
    Minute once{Fault{}};
    Minute twice{Fault{}};
    CHECK(once.operations() == twice.operations());
    CHECK_FALSE(once.is_fault_counted());
    once.check({});
}

TEST_CASE_METHOD(SteppedRig,
                 "one failed sync is an alarm for 10 s, and its data are written again at once") {
    test::FailingFiles failing;
    Store store(failing, options(), clock, reads);
    begin_session();
    advance(store, seconds(10));
    failing.set({1, Fault::Kind::sync});
    while (status_of(store).more_counters.at("journal_faults") == 0) advance(store, kStep);
    advance(store, 2 * kStep);
    failing.set({});
    const auto segments = journal::segment_files(root / "journal");
    CHECK(segments.size() == 2);
    CHECK(read_journal(root).bytes == bytes);
    const Status alarmed = status_of(store);
    CHECK(alarmed.level == Status::Level::fault);
    CHECK(alarmed.reasons.at(0).english().find("journal: ") == 0);
    CHECK(alarmed.journaled.value() > fed - 100);
    advance(store, seconds(10));
    CHECK(status_of(store).level == Status::Level::good);
    CHECK(store.stop());
}

TEST_CASE("whichever file operation fails, every journaled sample is archived once") {
    const struct {
        Fault::Kind kind;
        const char* name;
    } kinds[] = {{Fault::Kind::any, "EIO"},
                 {Fault::Kind::full_disk, "ENOSPC"},
                 {Fault::Kind::short_write, "short write"},
                 {Fault::Kind::sync, "failed fdatasync"}};
    const int stride = test::is_long() ? 1 : kShortStride;
    for (const auto& [kind, name] : kinds) {
        for (const bool lasts : {false, true}) {
            const int operations = Minute(Fault{0, kind}).operations();
            int tried = 0, counted = 0;
            for (int n = 1; n <= operations; n += stride, ++tried) {
                const Fault fault{n, kind, lasts};
                Minute minute(fault);
                minute.check(fault);
                counted += minute.is_fault_counted();
            }
            std::printf("%s, %s: %d of %d operations failed, %d counted in the status\n", name,
                        lasts ? "from n on" : "once", tried, operations, counted);
        }
    }
}
