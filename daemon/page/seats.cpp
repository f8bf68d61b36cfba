#include "daemon/page/seats.hpp"

#include <algorithm>
#include <utility>

namespace a351::daemon::page {

Seats::Place Seats::seat(Holder holder) {
    const auto counts = [](const Holder& one) { return !one.is_leaving; };
    const auto is_neighbour = [&](const Holder& one) {
        return counts(one) && one.address == holder.address;
    };
    const auto is_foreign = [&](const Holder& one) { return counts(one) && !one.is_loopback; };
    const auto make_room = [&](const auto& may_leave) {
        const auto oldest = std::ranges::find_if(
            holders_, [&](const Holder& one) { return may_leave(one) && one.is_waiting; });
        if (oldest == holders_.end()) return false;
        oldest->is_leaving = true;
        oldest->leave();
        return true;
    };
    if (!holder.is_loopback) {
        if (std::ranges::count_if(holders_, is_neighbour) >= std::ptrdiff_t{kOfOneAddress} &&
            !make_room(is_neighbour))
            return holders_.end();
        if (std::ranges::count_if(holders_, is_foreign) >= std::ptrdiff_t{kMost - kForLoopback} &&
            !make_room(is_foreign))
            return holders_.end();
    }
    if (std::ranges::count_if(holders_, counts) >= std::ptrdiff_t{kMost} && !make_room(counts))
        return holders_.end();
    return holders_.insert(holders_.end(), std::move(holder));
}

void Seats::was_answered(Place place) {
    place->is_waiting = true;
    holders_.splice(holders_.end(), holders_, place);
}

}  // namespace a351::daemon::page
