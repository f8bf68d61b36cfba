#include "daemon/recorder/reload.hpp"

#include <filesystem>
#include <system_error>

namespace a351::daemon::recorder {

survey::OccupationOptions occupation_options(const config::Config& config) {
    return {.planned = config.survey.planned,
            .planned_set_ups = config.survey.set_ups,
            .faces = config.survey.faces,
            .sites_file = config.survey.sites_file,
            .station = text::Site{"[station]", config.station.longitude, config.station.latitude,
                                  config.station.elevation, std::nullopt}};
}

gravity::GravityOptions gravity_options(const config::Config& config) {
    const config::SurveyConfig& survey = config.survey;
    std::error_code no_proc;  // Without /proc the corrector is not found, and the page says so.
    const auto self = std::filesystem::read_symlink("/proc/self/exe", no_proc);
    gravity::GravityOptions options = gravity::options_for(
        self.parent_path() / "a351-correct",
        {config.storage.root, survey.sites_file, survey.calibration_file}, survey.gravity_every);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    options.limits.memory_bytes = 0;  // sanitizers reserve terabytes
#endif
    return options;
}

void reload(const config::Config& config, const ReloadedParts& parts,
            const std::function<void()>& then) {
    const config::Config fresh = config::read_config(config.file);
    parts.live.judge_by(fresh.verdict);
    config::Config with_sites = config;
    with_sites.survey.sites_file = fresh.survey.sites_file;
    parts.gravity.use(gravity_options(with_sites));
    parts.page.post([&occupations = parts.occupations, then, sites = fresh.survey.sites,
                     options = occupation_options(fresh)] {
        occupations.use(sites, options);
        then();
    });
}

}  // namespace a351::daemon::recorder
