#pragma once

#include <functional>

#include "daemon/config/config.hpp"
#include "daemon/gravity/gravity_so_far.hpp"
#include "daemon/live/live_record.hpp"
#include "daemon/page/server.hpp"
#include "daemon/survey/occupations.hpp"

namespace a351::daemon::recorder {

/// Returns the plan of a stay and the list that gets new sites.
[[nodiscard]] survey::OccupationOptions occupation_options(const config::Config& config);

/// Returns what computes the gravity so far: the corrector beside this program, on its data root.
[[nodiscard]] gravity::GravityOptions gravity_options(const config::Config& config);

/// The parts of the recorder that take a configuration which is read again.
struct ReloadedParts {
    live::Record& live;
    survey::Occupations& occupations;
    gravity::GravitySoFar& gravity;
    page::Server& page;
};

/// Reads the configuration again, and takes sites, the plan of a stay and thresholds from it.
/// @param config  that of the start.
/// @param then    is called on the page's thread when the occupations have their new sites and plan.
/// @throws InputError  the file is refused, and nothing was changed.
void reload(const config::Config& config, const ReloadedParts& parts,
            const std::function<void()>& then);

}  // namespace a351::daemon::recorder
