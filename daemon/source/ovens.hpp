#pragma once

#include <optional>

#include "daemon/source/oven_link.hpp"

namespace a351::daemon::source {

/// The links of the ovens that are configured.
struct Ovens {
    std::optional<OvenLink> inner, outer;

    void start() {
        if (inner) inner->start();
        if (outer) outer->start();
    }
    void stop() {
        if (inner) inner->stop();
        if (outer) outer->stop();
    }
};

}  // namespace a351::daemon::source
