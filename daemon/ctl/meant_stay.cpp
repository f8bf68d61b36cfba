#include "daemon/ctl/meant_stay.hpp"

#include <nlohmann/json.hpp>

#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {

std::optional<MeantStay> meant_stay(const nlohmann::json& status,
                                    const nlohmann::json& occupations) {
    const auto made = [](const nlohmann::json& stay, const std::string& times) {
        const auto key = stay.at("key").get<std::string>(),
                   site = stay.at("site").get<std::string>();
        return MeantStay{
            key, site,
            text::tr("{}, stay {} ({}), {}", site, stay.at("number").get<int>(), key, times)};
    };
    const nlohmann::json& running = status.at("occupation");
    if (!running.is_null())
        return made(running, text::tr("running since {}", running.at("start").get<std::string>()));
    const nlohmann::json& finished = occupations.at("occupations");
    if (!finished.is_array() || finished.empty()) return std::nullopt;
    const nlohmann::json& set_ups = finished.back().at("set_ups");
    if (!set_ups.is_array() || set_ups.empty()) return std::nullopt;
    return made(finished.back(),
                text::tr("{} to {}", set_ups.front().at("start").get<std::string>(),
                         set_ups.back().at("end").get<std::string>()));
}

}  // namespace a351::daemon::ctl
