#include "daemon/page/seats.hpp"

#include <algorithm>
#include <utility>

namespace a351::daemon::page {
namespace {

/// Returns true if a client finds no room: all places are taken, or all of those for other computers.
template <class IsCounted>
bool is_full(const std::list<Seats::Holder>& holders, IsCounted is_counted, std::size_t most,
             bool is_loopback) {
    std::size_t all = 0, of_others = 0;
    for (const Seats::Holder& one : holders)
        if (is_counted(one)) {
            ++all;
            if (!one.is_loopback) ++of_others;
        }
    return all >= most || (!is_loopback && of_others >= most - Seats::kForLoopback);
}

}  // namespace

Seats::Place Seats::seat(Holder holder) {
    const auto is_seated = [](const Holder& one) { return !one.is_leaving; };
    const auto is_of_address = [&](const Holder& one) {
        return is_seated(one) && one.address == holder.address;
    };
    if (!holder.is_loopback &&
        std::ranges::count_if(holders_, is_of_address) >= std::ptrdiff_t{kOfOneAddress})
        return holders_.end();
    if (is_full(holders_, is_seated, kMost, holder.is_loopback)) {
        const auto oldest = std::ranges::find_if(holders_, [&](const Holder& one) {
            return is_seated(one) && !one.is_streaming && (holder.is_loopback || !one.is_loopback);
        });
        if (oldest == holders_.end()) return oldest;
        oldest->is_leaving = true;
        oldest->leave();
    }
    return holders_.insert(holders_.end(), std::move(holder));
}

bool Seats::begin_stream(Place place) {
    const auto is_streaming = [](const Holder& one) { return one.is_streaming; };
    return place->is_streaming = !is_full(holders_, is_streaming, kMostStreams, place->is_loopback);
}

}  // namespace a351::daemon::page
