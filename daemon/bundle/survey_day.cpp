#include "daemon/bundle/survey_day.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/bundle/open_file.hpp"

namespace a351::daemon::bundle {
namespace {

constexpr std::chrono::hours kWarmUp{12};

TextFile copy_of(const std::filesystem::path& file, const char* name) {
    std::error_code error;
    // An operator may keep the list anywhere, and name it by a link.
    const std::filesystem::path place = std::filesystem::canonical(file, error);
    if (error)
        throw std::system_error(error, "the list or calibration " + file.string() +
                                           " is part of the copy: put it back");
    const OpenFile original(place);
    return {name, original.read(0, original.size())};
}

}  // namespace

UtcTime begin_of(const SurveyDay& day) {
    std::optional<UtcTime> last = day.running;
    for (const events::Occupation& stay : day.stays)
        last = std::max(last, std::optional(stay.set_ups.back().start));
    if (!last) return day.now - std::chrono::days(1);
    const auto stays = events::survey_day(day.stays, *last);
    return (stays.empty() ? *last : stays.front().set_ups.front().start) - kWarmUp;
}

Contents contents_of(const SurveyDay& day) {
    const std::string name = day.station + '_' + to_compact(day.now);
    Contents contents{
        .folder = name,
        .root = day.root,
        .from = begin_of(day),
        .texts = {{"a351d.toml", day.configuration}, {"gravity-so-far.json", day.gravity_so_far}},
        .now = std::chrono::floor<std::chrono::seconds>(day.now)};
    if (day.sites.empty()) return contents;
    std::string survey =
        "# a351-correct survey takes this file, or its folder.\n[survey]\nname = \"" + name +
        "\"\nroot = \".\"\nsites = \"sites.csv\"\n";
    contents.texts.push_back(copy_of(day.sites, "sites.csv"));
    if (!day.calibration.empty()) {
        survey += "calibration = \"calibration.toml\"\n";
        contents.texts.push_back(copy_of(day.calibration, "calibration.toml"));
    }
    contents.texts.push_back({"survey.toml", survey});
    return contents;
}

}  // namespace a351::daemon::bundle
