#pragma once
/// @file
/// A device with a fault script, and a host that receives everything.

#include <algorithm>
#include <map>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/timing/sample_index.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "sim/line/fault_injector.hpp"
#include "sim/noise/random.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

namespace a351::sim::line {

using namespace std::chrono_literals;
using Kind = timing::Placement::Kind;

/// Result of decoding the bytes as a host does.
struct Decoded {
    std::vector<wire::BurstValues> frames;
    std::map<Kind, int> places;
    std::int64_t missing = 0;
    std::size_t bytes_skipped = 0;
};

struct Rig {
    explicit Rig(const std::string& toml)
        : faults(parse_fault_script(toml, "script.toml", UtcTime(0s), rules), UtcTime(0s), line,
                 bench.machine, rules.profile, {}, [this](std::string_view kind, int count) {
                     if (!oven_trouble.empty()) throw InputError(oven_trouble);
                     oven = std::string(kind) + " " + std::to_string(count);
                     return true;
                 }) {
        bench.start_logging();
    }

    void run_to(UtcTime end) {
        for (; now <= end; now += 100ms) {
            const device::Instant instant{now, bench.now};
            faults.begin(instant);
            stream.advance_to(instant, faults);
            faults.catch_up(instant);
            const auto shown = line.shown(now);
            bytes.insert(bytes.end(), shown.begin(), shown.end());
            line.handed_over(shown.size(), now);
        }
    }

    [[nodiscard]] Decoded decoded() const {
        Decoded decoded;
        wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
        timing::SampleIndex index(80, Hertz(50));
        std::span<const std::byte> input(bytes);
        while (const auto event = decoder.next(input)) {
            if (const auto* lost = std::get_if<wire::Discarded>(&*event)) {
                decoded.bytes_skipped += lost->byte_count;
                continue;
            }
            const auto& values = std::get<wire::BurstFrame>(*event).values();
            decoded.frames.push_back(values);
            const RawTime arrival(static_cast<std::int64_t>(decoded.frames.size()) * 20ms);
            auto place = index.place(values.count, true, arrival);
            ++decoded.places[place.kind];
            decoded.missing += place.missing;
            if (place.kind != Kind::new_session) continue;
            index = timing::SampleIndex(80, Hertz(50));
            static_cast<void>(index.place(values.count, true, arrival));
        }
        decoded.bytes_skipped += decoder.pending_bytes();
        return decoded;
    }

    [[nodiscard]] std::vector<wire::BurstValues> arrived() const {
        std::vector<wire::BurstValues> values;
        for (const truth::Record& record : truth) {
            if (record.fate != truth::Fate::damaged && record.fate != truth::Fate::lost) {
                values.push_back(record.values);
            }
        }
        return values;
    }

    /// Has the device take commands as from the host's line.
    void receive(std::string_view hex) {
        stream.receive(device::bytes_of(hex), {now, bench.now}, faults);
    }

    /// Returns how often a kind of fault has been applied.
    [[nodiscard]] std::int64_t made(FaultKind kind) const {
        return faults.report().by_kind[static_cast<std::size_t>(kind)];
    }

    /// Plugs the device in again after the hang-up that is due.
    void end_hang_up() {
        const auto hang_up = faults.take_hang_up();
        REQUIRE(hang_up);
        faults.end_hang_up(*hang_up, {now, bench.now});
    }

    [[nodiscard]] std::int64_t count(truth::Fate fate) const {
        return std::ranges::count(truth, fate, &truth::Record::fate);
    }

    FaultRules rules{*wire::find_profile("A352AD10"), 1.0, {"oven_silence"}};
    noise::RandomStream noise{1, "test"};
    device::GridSource source{50, [this](std::int64_t) {
                                  const auto draw = [this] {
                                      return static_cast<std::int32_t>(noise.bits() >> 44U);
                                  };
                                  return signal::SensorSample{{draw(), draw(), draw()}, draw()};
                              }};
    device::Bench bench;
    device::DeviceStream stream{source, bench.machine};
    std::vector<truth::Record> truth;
    Line line{{}, 1, UtcTime(0s), [this](const truth::Record& record) { truth.push_back(record); }};
    FaultInjector faults;
    UtcTime now{0s};
    std::vector<std::byte> bytes;
    std::string oven, oven_trouble;
};

inline std::string fault(const std::string& kind, const std::string& keys) {
    return "[[fault]]\nkind = \"" + kind + "\"\n" + keys + "\n";
}

/// Runs the rig up to 30 s and checks the emulator's report against the frames that a host decodes.
/// @return the result of the host
inline Decoded check_report(Rig& rig) {
    rig.run_to(UtcTime(30s));
    const Decoded decoded = rig.decoded();
    const Report& report = rig.line.report();
    CHECK(decoded.frames == rig.arrived());
    CHECK(static_cast<std::int64_t>(decoded.frames.size()) == report.frames_sent);
    CHECK(static_cast<std::int64_t>(decoded.bytes_skipped) ==
          report.bytes_handed_over - report.bytes_of_frames);
    CHECK(report.bytes_handed_over == static_cast<std::int64_t>(rig.bytes.size()));
    CHECK(report.frames_damaged == rig.count(truth::Fate::damaged));
    CHECK(report.frames_lost == rig.count(truth::Fate::lost));
    CHECK(report.frames_repeated == rig.count(truth::Fate::repeated));
    CHECK(report.frames_misplaced == rig.count(truth::Fate::misplaced));
    return decoded;
}

}  // namespace a351::sim::line
