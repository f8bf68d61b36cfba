#pragma once
/// @file
/// A store driven by one thread, on a clock that only the test moves.  Every run does the same file
/// operations in the same order.

#include "tests/unit/daemon/store_rig.hpp"

namespace a351::daemon {

inline constexpr Nanoseconds kStep = std::chrono::milliseconds(250);

struct SteppedRig : Rig {
    UtcTime utc = *parse_rfc3339("2026-03-01T12:00:00Z");
    std::chrono::steady_clock::time_point real{std::chrono::hours(1)};

    SteppedRig() {
        set(utc);
        first = clock.raw() + kPeriod;
    }

    [[nodiscard]] store::Options options() const {
        store::Options options = Rig::options();
        options.time.now = [this] { return real; };
        options.time.retry_interval = std::chrono::seconds(10);
        options.commit_patience = std::chrono::milliseconds(0);
        return options;
    }

    /// Returns the values of sample i.  Their counts look like noise, so that records are as long
    /// as in the field.
    static wire::BurstValues values(int i) {
        wire::BurstValues values = FakeSensor::values(i);
        for (std::size_t axis = 0; axis < values.axes.size(); ++axis)
            values.axes[axis] = counts(i, axis);
        return values;
    }
    /// Returns the counts of sample i on an axis; axis 3 is the temperature.
    static std::int32_t counts(int i, std::size_t axis) {
        if (axis == 3) return FakeSensor::values(i).temperature;
        const auto mixed = (static_cast<std::uint32_t>(i) * 3 + static_cast<std::uint32_t>(axis)) *
                           2'654'435'761U;  // Knuth's multiplier: a permutation that looks random.
        return static_cast<std::int32_t>(mixed >> 20) + 16'000'000;
    }

    Nanoseconds period = kPeriod;     ///< From frame to frame.
    Nanoseconds largest_lateness{0};  ///< Largest delay of a frame; less than a period.

    /// Returns the arrival time of the frame of sample i.
    [[nodiscard]] UtcTime arrival(int i) const {
        const Nanoseconds late = largest_lateness * (counts(i, 0) % 256) / 256;
        return UtcTime((first + i * period + late).time_since_epoch());
    }

    /// Moves the clock on by `span`.  Every 250 ms frames arrive, and the store takes one step.
    void advance(store::Store& store, Nanoseconds span) {
        for (Nanoseconds done{0}; done < span; done += kStep) {
            pass(kStep);
            for (std::vector<std::byte> frame; arrival(fed) <= utc; ++fed, frame.clear()) {
                wire::append_frame(wire::BurstLayout::recommended(), values(fed), frame);
                REQUIRE(reads.push(source::ReadQueue::Kind::rx,
                                   RawTime(arrival(fed).time_since_epoch()), frame));
                bytes.insert(bytes.end(), frame.begin(), frame.end());
            }
            store.step();
        }
    }

    /// Moves the clock on by `span` without any frame.
    void pass(Nanoseconds span) {
        set(utc + span);
        real += std::chrono::duration_cast<std::chrono::steady_clock::duration>(span);
    }

    /// Sets the clock back; frames continue at their period.
    void set_clock_back(Nanoseconds by) {
        set(utc - by);
        first = clock.raw() + period - fed * period;
    }

    /// @return true if the store accepted the event
    static bool commit(store::Store& store, const events::Event& event) {
        try {
            store.commit(event);
            return true;
        } catch (const std::system_error&) {
            return false;
        }
    }

private:
    void set(UtcTime now) {
        utc = now;
        clock = source::HostClock(ClockScale{1e-15, now, source::host_realtime()});
    }
};

inline std::vector<std::int32_t> stepped_counts(int frames, std::size_t axis) {
    std::vector<std::int32_t> counts;
    for (int i = 0; i < frames; ++i) counts.push_back(SteppedRig::counts(i, axis));
    return counts;
}

}  // namespace a351::daemon
