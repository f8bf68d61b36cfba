#include "tests/simulation/host.hpp"

#include <sys/file.h>

#include <ctime>
#include <fstream>
#include <utility>

#include "tests/simulation/real_calls.hpp"

namespace a351::simulation {
namespace {

Host* only_host = nullptr;

}  // namespace

Host::Host(std::uint64_t seed, Schedule& schedule, UtcTime start, std::filesystem::path folder)
    : schedule_(schedule),
      start_(start),
      boot_id_(std::move(folder) / "boot_id"),
      random_(seed, "host") {
    boot();
    only_host = this;
}

Host::~Host() { only_host = nullptr; }

Host* Host::mine() noexcept { return Schedule::mine() == nullptr ? nullptr : only_host; }

void Host::boot() {
    booted_ = schedule_.now();
    booted_slept_ = slept_;
    std::ofstream(boot_id_) << random_.bits();
}

Nanoseconds Host::read(int clock_id) {
    const Nanoseconds now = schedule_.read_clock();
    switch (clock_id) {
        case CLOCK_REALTIME:
            return true_time().time_since_epoch() + realtime_error_;
        case CLOCK_BOOTTIME:
            return now - booted_ + slept_ - booted_slept_;
        default:
            return now - booted_;
    }
}

Nanoseconds Host::schedule_time(int clock_id, Nanoseconds reading) {
    return schedule_.now() + (reading - read(clock_id));
}

void Host::release_locks() {
    for (const int descriptor : std::exchange(locks_, {})) real().lock_file(descriptor, LOCK_UN);
}

}  // namespace a351::simulation
