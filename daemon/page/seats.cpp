#include "daemon/page/seats.hpp"

#include <algorithm>
#include <utility>

namespace a351::daemon::page {
namespace {

/// Returns the part of `most` that a client may take.
std::ptrdiff_t part_of(std::size_t most, bool is_loopback) {
    return static_cast<std::ptrdiff_t>(is_loopback ? most : most - Seats::kForLoopback);
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
    if (std::ranges::count_if(holders_, is_seated) >= part_of(kMost, holder.is_loopback)) {
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
    return place->is_streaming = std::ranges::count(holders_, true, &Holder::is_streaming) <
                                 part_of(kMostStreams, place->is_loopback);
}

}  // namespace a351::daemon::page
