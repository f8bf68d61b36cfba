/// The words of the signal on simulated survey days, in the time of the data.
///
///     signal_words_bench FIRST_SEED DAYS
///
/// Days are of tsukuba and hot-afternoon, with one set-up of 12 min in each stay or two of 6 min; the
/// box stands for five minutes more.  Counted are:
/// - time from the end of the plan to YOU CAN GO, and stays with LOOK, without a mistake;
/// - stays with LOOK when *Next set-up* comes 60 s before to 120 s after the lifting;
/// - the same of days with two set-ups whose box is turned over in between;
/// - days on which LOOK names the box that was lifted and set down without *Next set-up*, in the stay.
/// Without a corrector LOOK comes from the motion of the box alone; signal_bench.py has what the
/// readings contradict.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/survey/operator_signal.hpp"
#include "sim/noise/random.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

namespace {

using namespace a351;
using namespace a351::daemon;
using sim::scenario::PlannedSetUp;

constexpr double kPlan_s = 720.0, kLonger_s = 300.0, kMostLate_s = 10.0;

enum class Press { at_lifting, beside_lifting, forgotten };

/// A recorder whose samples have the time of the simulated sensor.
class SimulatedRecorder final : public FakeRecorder {
public:
    std::optional<survey::Instant> latest() override { return at(now); }
    std::optional<survey::Instant> at(UtcTime utc) override {
        if (utc > now) return std::nullopt;
        return survey::Instant{session, index, utc};
    }

    UtcTime now = UtcTime::min();
    std::int64_t index = 0;
};

struct Change {
    survey::Word word;
    UtcTime utc;
};

struct Stay {
    std::optional<double>
        late_s;  ///< From the end of the plan to YOU CAN GO; empty: it did not come.
    bool has_look = false;
    bool is_forgotten = false;  ///< The box was lifted without *Next set-up*.
};

/// An action of the operator.
struct Order {
    enum class Kind { start, setup, stop } kind;
    std::string site;
};

/// @param forgotten  is set to the number of the stay without *Next set-up*, if there is one.
std::multimap<UtcTime, Order> orders_of(const std::vector<PlannedSetUp>& plan, Press press,
                                        sim::noise::RandomStream& draws,
                                        std::ptrdiff_t& forgotten) {
    const auto stays = std::ranges::count(plan, 1, &PlannedSetUp::part);
    forgotten = press == Press::forgotten
                    ? static_cast<std::ptrdiff_t>(draws.uniform() * static_cast<double>(stays))
                    : -1;
    std::multimap<UtcTime, Order> orders;
    std::ptrdiff_t stay = -1;
    for (const PlannedSetUp& set_up : plan) {
        if (set_up.part == 1) {
            ++stay;
            orders.emplace(set_up.start, Order{Order::Kind::start, set_up.site.name});
        } else if (stay != forgotten) {
            const double after_s =
                press == Press::beside_lifting ? draws.uniform(-60.0, 120.0) : 0.0;
            orders.emplace(set_up.start + from_seconds(after_s), Order{Order::Kind::setup, {}});
        }
        if (set_up.part == set_up.parts) orders.emplace(set_up.end, Order{Order::Kind::stop, {}});
    }
    return orders;
}

std::vector<Stay> walk(const std::string& name, int set_ups, std::uint64_t seed, Press press,
                       const std::string& faces) {
    auto scenario = sim::scenario::load_scenario(name);
    scenario.schedule.set_ups = set_ups;
    scenario.schedule.faces = faces;
    scenario.schedule.length_s = kPlan_s + kLonger_s;
    scenario.schedule.jitter_s = 0.0;
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    sim::signal::Source source(scenario, profile, seed);
    sim::noise::RandomStream draws(seed, "operator");
    std::ptrdiff_t forgotten = -1;
    auto orders = orders_of(source.plan(), press, draws, forgotten);

    SimulatedRecorder recorder;
    std::vector<text::Site> sites;
    for (const PlannedSetUp& set_up : source.plan())
        if (std::ranges::count(sites, set_up.site.name, &text::Site::name) == 0)
            sites.push_back(set_up.site);
    survey::Occupations occupations(
        recorder, sites, {},
        {.planned = from_seconds(kPlan_s), .planned_set_ups = set_ups, .faces = faces});
    live::Record live(profile, sim::signal::Source::kRateHz, {});
    status::Status status;
    std::vector<Change> said;
    survey::SignalLog log(occupations, live, [&](const events::Event& event) {
        const std::string& code = event.details.at("word");
        for (const auto word :
             {survey::Word::no_data, survey::Word::warming_up, survey::Word::keep_off,
              survey::Word::lift, survey::Word::go, survey::Word::look})
            if (code == survey::code_of(word)) said.push_back({word, event.utc});
    });

    std::vector<Stay> stays;
    UtcTime first_set_up, last_set_up;  // of the running stay
    std::size_t said_before = 0;
    const auto obey = [&](const Order& order) {
        status.now = recorder.now;
        log.advance(status, {});
        if (order.kind == Order::Kind::start) {
            said_before = said.size();
            first_set_up = recorder.now;
            (void)occupations.start(order.site, {}, {});
        } else if (order.kind == Order::Kind::setup) {
            (void)occupations.setup({});
        } else {
            Stay& stay = stays.emplace_back();
            stay.is_forgotten = std::ssize(stays) - 1 == forgotten;
            for (std::size_t i = said_before; i < said.size(); ++i) {
                stay.has_look = stay.has_look || said[i].word == survey::Word::look;
                if (said[i].word == survey::Word::go && !stay.late_s && said[i].utc >= last_set_up)
                    stay.late_s = seconds_between(
                        std::max(last_set_up + from_seconds(kPlan_s / set_ups),
                                 first_set_up + from_seconds(kPlan_s)),
                        said[i].utc);
            }
            (void)occupations.stop({}, {});
        }
        if (order.kind != Order::Kind::stop) last_set_up = recorder.now;
    };
    while (source.next_instant()) {
        const auto sample = source.next();
        for (; !orders.empty() && orders.begin()->first <= sample.instant;
             orders.erase(orders.begin()))
            obey(orders.begin()->second);
        live.take({recorder.index,
                   sample.instant,
                   {sample.values.axes_counts[0], sample.values.axes_counts[1],
                    sample.values.axes_counts[2], sample.values.temperature_counts}});
        recorder.now = sample.instant;
        ++recorder.index;
    }
    for (const auto& [time, order] : orders) obey(order);
    return stays;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("usage: signal_words_bench FIRST_SEED DAYS\n", stderr);
        return 2;
    }
    const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10);
    const int days = std::atoi(arguments[2]);
    struct Kind {
        const char* scenario;
        int set_ups;
        Press press;
        const char* faces = "+";
    };
    bool is_kept = true;
    for (const Kind kind :
         {Kind{"tsukuba", 1, Press::at_lifting}, Kind{"hot-afternoon", 1, Press::at_lifting},
          Kind{"tsukuba", 2, Press::at_lifting}, Kind{"hot-afternoon", 2, Press::at_lifting},
          Kind{"tsukuba", 2, Press::at_lifting, "+-"}, Kind{"tsukuba", 2, Press::beside_lifting},
          Kind{"tsukuba", 4, Press::beside_lifting, "+--+"},
          Kind{"tsukuba", 2, Press::forgotten}}) {
        std::vector<std::future<std::vector<Stay>>> walks;
        std::size_t stays = 0, in_time = 0, looks = 0, named = 0;
        double latest_s = 0.0;
        for (int day = 0; day < days; day += 2) {
            walks.clear();
            for (int k = day; k < std::min(day + 2, days); ++k)
                walks.push_back(std::async(std::launch::async, walk, kind.scenario, kind.set_ups,
                                           first + static_cast<std::uint64_t>(k), kind.press,
                                           kind.faces));
            for (auto& one : walks) {
                const auto found = one.get();
                stays += found.size();
                in_time +=
                    static_cast<std::size_t>(std::ranges::count_if(found, [](const Stay& stay) {
                        return stay.late_s && *stay.late_s >= -1.0 && *stay.late_s <= kMostLate_s;
                    }));
                for (const Stay& stay : found)
                    latest_s = std::max(latest_s, stay.late_s.value_or(0.0));
                for (const Stay& stay : found) {
                    if (stay.has_look && stay.is_forgotten) ++named;
                    if (stay.has_look && !stay.is_forgotten) ++looks;
                }
            }
        }
        const bool is_forgotten = kind.press == Press::forgotten;
        const auto mistakes = is_forgotten ? static_cast<std::size_t>(days) : 0;
        std::printf(
            "%s, %d set-ups, faces %s, %s: %zu stays, YOU CAN GO within %.0f s of the plan at %zu, "
            "at most "
            "%.1f s; "
            "LOOK at %zu stays without a mistake, and at %zu of %zu with one\n",
            kind.scenario, kind.set_ups, kind.faces,
            is_forgotten                          ? "one Next set-up forgotten"
            : kind.press == Press::beside_lifting ? "Next set-up beside the lifting"
                                                  : "no mistake",
            stays, kMostLate_s, in_time, latest_s, looks, named, mistakes);
        std::fflush(stdout);
        is_kept = is_kept &&
                  (is_forgotten ? 20 * named >= 19 * static_cast<std::size_t>(days) : looks == 0);
    }
    std::puts(is_kept ? "all promises kept" : "NOT REACHED: a word too late, missing or false");
    return is_kept ? 0 : 1;
}
