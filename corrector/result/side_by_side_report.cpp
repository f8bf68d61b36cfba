#include "corrector/result/side_by_side_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "corrector/result/scale_report.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {

using Json = nlohmann::ordered_json;

std::vector<std::string> side_by_side_sentences(const model::SurveyCorrection& result) {
    if (!result.side_by_side) return {};
    const model::SideBySide& both = *result.side_by_side;
    std::vector<std::string> instruments;
    for (const model::ScaleEstimate& scale : both.scales) instruments.push_back(scale.instrument);
    const std::string names = text::joined(instruments);
    std::vector<std::string> sentences;
    if (const auto scatter = both.scatter_mgal()) {
        std::vector<double> u_mgal;
        for (const model::ComparedStation& station : both.stations)
            u_mgal.push_back(station.u_ours.value());
        sentences.push_back(text::tr(
            "side by side with {}: at {} stations the sensor differs by {} mGal rms, each station "
            "with its own reference hidden (cross-validated); its stated uncertainty is {} mGal "
            "rms",
            names, both.stations.size(), text::fixed(*scatter, 2),
            text::fixed(*model::root_mean_square(u_mgal), 2)));
    }
    if (both.bias)
        sentences.push_back(text::tr("bias of the sensor against {}: {} +- {} mGal", names,
                                     text::fixed(both.bias->value, 1),
                                     text::fixed_or(both.bias->standard_error, 1, "-")));
    if (!both.is_level_known)
        sentences.push_back(text::tr(
            "no station has a published gravity: the level is that of the sensor, so its bias is "
            "not known and only differences of gravity mean something"));
    return sentences;
}

std::vector<Column<model::ComparedStation>> side_by_side_columns() {
    using Row = const model::ComparedStation&;
    return {
        {"site", of(&model::ComparedStation::site), {text::marked("Station"), 0, 'n'}},
        {"ours_mgal", of(&model::ComparedStation::ours), {text::marked("Ours mGal")}},
        {"u_ours_mgal", of(&model::ComparedStation::u_ours), {"u mGal", 2}},
        {"theirs_mgal", of(&model::ComparedStation::theirs), {text::marked("Theirs mGal")}},
        {"u_theirs_mgal", of(&model::ComparedStation::u_theirs), {"u mGal", 3}},
        {"difference_mgal",
         [](Row row) { return cell(row.difference()); },
         {text::marked("Difference mGal"), 2}},
    };
}

Json side_by_side_json(const model::SurveyCorrection& result) {
    if (!result.side_by_side) return nullptr;
    const model::SideBySide& both = *result.side_by_side;
    Json bias = nullptr;
    if (both.bias)
        bias = {{"value", both.bias->value}, {"u", text::or_null(both.bias->standard_error)}};
    return {{"reference_scales", scales_json(both.scales)},
            {"reference_readings", both.reading_count},
            {"reference_s0", text::or_null(both.s0)},
            {"is_level_known", both.is_level_known},
            {"bias_mgal", bias},
            {"scatter_mgal", text::or_null(both.scatter_mgal())},
            {"stations", json_array(side_by_side_columns(), both.stations)}};
}

}  // namespace a351::corrector::result
