#include "daemon/page/seats.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace a351::daemon::page {

std::string host_of(const boost::asio::ip::address& address) {
    if (address.is_v4() || address.is_loopback()) return address.to_string();
    const auto v6 = address.to_v6();
    auto bytes = v6.to_bytes();
    const bool is_private = (bytes[0] & 0xfe) == 0xfc;  // fc00::/7, RFC 4193.
    if (is_private || v6.is_link_local() || v6.is_v4_mapped()) return address.to_string();
    std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), std::uint8_t{0});
    return boost::asio::ip::address_v6(bytes).to_string();
}

Seats::Place Seats::seat(Holder holder) {
    const auto counts = [](const Holder& one) { return !one.is_leaving; };
    const auto is_neighbour = [&](const Holder& one) {
        return counts(one) && one.host == holder.host;
    };
    const auto is_foreign = [&](const Holder& one) { return counts(one) && !one.is_loopback; };
    const auto make_room = [&](const auto& may_leave) {
        const auto oldest = std::ranges::find_if(
            holders_, [&](const Holder& one) { return may_leave(one) && !one.is_streaming; });
        if (oldest == holders_.end()) return false;
        oldest->is_leaving = true;
        oldest->leave();
        return true;
    };
    if (!holder.is_loopback) {
        if (std::ranges::count_if(holders_, is_neighbour) >= std::ptrdiff_t{kOfOneHost} &&
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

bool Seats::begin_stream(Place place) {
    std::size_t all = 0, foreign = 0, of_host = 0;
    for (const Holder& one : holders_) {
        if (!one.is_streaming) continue;
        ++all;
        if (!one.is_loopback) ++foreign;
        if (one.host == place->host) ++of_host;
    }
    const bool is_too_many =
        all >= kMostStreams || (!place->is_loopback && (foreign >= kMostStreams - kForLoopback ||
                                                        of_host >= kStreamsOfOneHost));
    return place->is_streaming = !is_too_many;
}

}  // namespace a351::daemon::page
