#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

namespace a351::daemon {

/// What the page's thread counts of itself.
struct PageUse {
    std::size_t connections = 0;         ///< Open now, live streams among them.
    std::size_t streams = 0;             ///< Live ones.
    std::uint64_t messages_dropped = 0;  ///< Not sent to a viewer that read too slowly.
    std::uint64_t failures = 0;          ///< Exceptions of a source.
};

/// Counts while it lives.
class Seat {
public:
    explicit Seat(std::size_t& taken) noexcept : taken_(&taken) { ++taken; }
    Seat(Seat&& other) noexcept : taken_(std::exchange(other.taken_, nullptr)) {}
    Seat& operator=(Seat&&) = delete;
    ~Seat() {
        if (taken_) --*taken_;
    }

private:
    std::size_t* taken_;
};

}  // namespace a351::daemon
