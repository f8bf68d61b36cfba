#include "daemon/recorder/day_file.hpp"

#include <memory>
#include <optional>

#include "daemon/bundle/survey_day.hpp"

namespace a351::daemon::recorder {

page::Download bundle_of_day(const config::Config& config, UtcTime now,
                             const survey::Occupations& occupations,
                             const std::string& gravity_so_far,
                             const std::function<void(const std::string& cause)>& failed) {
    const auto& running = occupations.running();
    const bundle::Contents contents = bundle::contents_of(
        {.root = config.storage.root,
         .sites = occupations.sites_file(),
         .calibration = config.survey.calibration_file,
         .station = config.station.codes.network + '_' + config.station.codes.station,
         .configuration = config.shown,
         .gravity_so_far = gravity_so_far,
         .stays = occupations.list(),
         .running = running ? std::optional(running->start) : std::nullopt,
         .now = now});
    const auto bundle = std::make_shared<bundle::Bundle>(contents);
    return {.name = contents.folder + ".tar",
            .open = [bundle] { return bundle->open(); },
            .next =
                [bundle, failed] {
                    try {
                        return bundle->next();
                    } catch (const std::exception& error) {
                        failed(error.what());
                        throw;
                    }
                }};
}

}  // namespace a351::daemon::recorder
