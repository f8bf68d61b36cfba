#include "corrector/long_record/applied_tables.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::long_record {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> cells(std::string name, const ThreeWays& ways) {
    return {std::move(name), text::fixed(ways.before, 3), text::fixed(ways.parametric, 3),
            text::fixed(ways.by_modes, 3)};
}

Json ways_json(const ThreeWays& ways) {
    return {{"before", ways.before}, {"parametric", ways.parametric}, {"by_modes", ways.by_modes}};
}

}  // namespace

TextTable applied_bands_table(const AppliedCalibration& applied) {
    TextTable rows{{text::tr("rms in mGal, period"), text::tr("before"), text::tr("parametric"),
                    text::tr("by modes")}};
    for (const BandScatter& band : applied.bands) {
        const std::string from = text::fixed(band.shortest_s, 0);
        rows.push_back(cells(std::isfinite(band.longest_s)
                                 ? text::tr("{} to {} s", from, text::fixed(band.longest_s, 0))
                                 : text::tr("{} s and more", from),
                             band.rms_mgal));
    }
    return rows;
}

TextTable allan_table(const AppliedCalibration& applied) {
    TextTable rows{{text::tr("Allan deviation in mGal"), text::tr("before"), text::tr("parametric"),
                    text::tr("by modes")}};
    for (const AllanPoint& point : applied.allan)
        rows.push_back(cells(text::tr("averages of {} s", text::fixed(point.averaging_s, 0)),
                             point.deviation_mgal));
    return rows;
}

std::vector<std::string> applied_sentences(const AppliedCalibration& applied) {
    std::vector<std::string> lines{
        text::in_words(applied.origin),
        text::tr("parametric: the two paths are applied to the smoothed temperature; by modes: "
                 "temperature modes with a period of {} s or more are scaled by the response at "
                 "their period, and shorter modes of the acceleration are averaged out, which "
                 "does not correct them",
                 text::fixed(applied.averaged_below_s, 0))};
    for (const text::Message& remark : applied.remarks) lines.push_back(text::in_words(remark));
    return lines;
}

std::string applied_text(const RecordResult& result) {
    if (!result.applied) return {};
    std::string text = text::aligned(applied_bands_table(*result.applied)) +
                       text::aligned(allan_table(*result.applied));
    for (const std::string& line : applied_sentences(*result.applied)) text += line + '\n';
    return text + '\n';
}

std::string applied_cells(const RecordResult& result, UtcTime time) {
    if (!result.applied) return {};
    const RecordSegment& segment = result.segment();
    const double place = seconds_between(segment.start, time) / result.record.step_s;
    if (place < -0.5 || time > segment.end) return ",,";
    const auto i = static_cast<std::size_t>(std::llround(std::max(0.0, place)));
    if (i >= segment.size()) return ",,";
    return fmt::format(",{},{}", text::shortest(result.applied->parametric_mgal[i]),
                       text::shortest(result.applied->by_modes_mgal[i]));
}

Json applied_json(const RecordResult& result) {
    if (!result.applied) return nullptr;
    Json json{{"calibration", result.applied->origin.english()},
              {"averaged_below_s", result.applied->averaged_below_s},
              {"bands", Json::array()},
              {"allan", Json::array()},
              {"remarks", text::in_english(result.applied->remarks)}};
    for (const BandScatter& band : result.applied->bands)
        json["bands"].push_back({{"shortest_s", band.shortest_s},
                                 {"longest_s", band.longest_s},
                                 {"rms_mgal", ways_json(band.rms_mgal)}});
    for (const AllanPoint& point : result.applied->allan)
        json["allan"].push_back({{"averaging_s", point.averaging_s},
                                 {"deviation_mgal", ways_json(point.deviation_mgal)}});
    return json;
}

}  // namespace a351::corrector::long_record
