#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"
#include "tests/simulation/schedule.hpp"

namespace a351::simulation {

/// The clocks, the locks on files and the random numbers of a simulated host.  Its calls are those
/// of the program under test, see interposed.cpp.
class Host {
public:
    /// @param folder  for its boot identifier.  There is one Host in a process.
    Host(std::uint64_t seed, Schedule& schedule, UtcTime start, std::filesystem::path folder);
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    ~Host();

    /// Returns the host of this process; null without a Schedule.
    [[nodiscard]] static Host* mine() noexcept;

    /// Returns the true time, which no clock of the host need show.
    [[nodiscard]] UtcTime true_time() const { return start_ + schedule_.now() + slept_; }

    /// Returns a clock of the kernel by its identifier.
    [[nodiscard]] Nanoseconds read(int clock_id);

    /// Returns when the waiting threads see a reading of a clock.
    [[nodiscard]] Nanoseconds schedule_time(int clock_id, Nanoseconds reading);

    void step_clock(Nanoseconds by) { realtime_error_ += by; }
    void sleep(Nanoseconds span) { slept_ += span; }  ///< Suspends the host.
    void boot();                                      ///< Begins after a power cut.

    void switch_synchronisation() { is_synchronised_ = !is_synchronised_; }
    [[nodiscard]] bool is_synchronised() const noexcept { return is_synchronised_; }

    [[nodiscard]] const std::filesystem::path& boot_id_file() const noexcept { return boot_id_; }
    [[nodiscard]] std::uint32_t random() { return static_cast<std::uint32_t>(random_.bits()); }

    void note_lock(int descriptor) { locks_.push_back(descriptor); }
    /// Releases all locks on files, because the process that had them ended.
    void release_locks();

private:
    Schedule& schedule_;
    UtcTime start_;
    std::filesystem::path boot_id_;
    sim::noise::RandomStream random_;
    Nanoseconds realtime_error_{0}, slept_{0}, booted_{0}, booted_slept_{0};
    std::vector<int> locks_;
    bool is_synchronised_ = true;
};

}  // namespace a351::simulation
