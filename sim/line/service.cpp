#include "sim/line/service.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

namespace a351::sim::line {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kLongestPatience = 100ms;  ///< Longest wait: a signal is noticed within it.

void wait(std::vector<pollfd>& descriptors, Nanoseconds timeout) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(timeout);
    const timespec limit{seconds.count(), (timeout - seconds).count()};
    if (::ppoll(descriptors.data(), descriptors.size(), &limit, nullptr) < 0 && errno != EINTR)
        throw std::system_error(errno, std::generic_category(), "wait for the ports");
}

}  // namespace

UtcTime host_now() {
    return std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now());
}

Nanoseconds steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

void attend(std::span<Service* const> services, const ClockScale& clock,
            const std::function<bool()>& should_stop) {
    const auto instant = [&clock] {
        return device::Instant{clock.simulated(host_now()), steady_now()};
    };
    std::vector<pollfd> descriptors;
    while (!should_stop()) {
        for (Service* service : services) service->serve(instant());
        descriptors.clear();
        Nanoseconds patience = kLongestPatience;
        const device::Instant now = instant();
        for (const Service* service : services) {
            service->watch(descriptors);
            patience = std::min(patience, service->patience(now, clock));
        }
        wait(descriptors, patience);
    }
}

}  // namespace a351::sim::line
