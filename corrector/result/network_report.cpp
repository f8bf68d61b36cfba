#include "corrector/result/network_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

using Json = nlohmann::ordered_json;

/// Comparison of adjusted stations with references that the network does not hold.
struct ReferenceCheck {
    std::size_t station_count = 0;
    double rms_mgal = 0.0;
};

ReferenceCheck check_references(const SurveyCorrection& result) {
    ReferenceCheck check;
    double squares = 0.0;
    for (const StationValue& station : result.stations) {
        bool is_held = false;
        for (const NetworkRow& row : result.network->rows) {
            is_held = is_held || row.label == "datum " + station.site;
        }
        if (is_held || station.is_flagged_only || !station.residual) continue;
        ++check.station_count;
        squares += station.residual->value() * station.residual->value();
    }
    if (check.station_count > 0) {
        check.rms_mgal = std::sqrt(squares / static_cast<double>(check.station_count));
    }
    return check;
}

}  // namespace

std::string network_text(const SurveyCorrection& result) {
    if (!result.network) return {};
    const NetworkAdjustment& network = *result.network;
    std::string text = "network: " + std::to_string(network.rows.size()) + " rows (" +
                       std::to_string(network.reading_count) + " readings, " +
                       std::to_string(network.datum_count) + " datum of sd " +
                       text::fixed(result.options.network.datum_sd_mgal, 3) + " mGal), " +
                       std::to_string(network.unknowns.size()) +
                       " unknowns, dof = " + std::to_string(network.dof) + '\n';
    const std::string sd = text::fixed(result.options.priors.reading_sd_mgal, 2);
    if (const auto passes = network.passes_global_test()) {
        text += "global test at 5 %: v'Wv = " + text::fixed(network.weighted_square, 2) +
                " within " + text::fixed(network.chi_square_low, 2) + " to " +
                text::fixed(network.chi_square_high, 2) + ": " + (*passes ? "passed" : "FAILED") +
                "; s0 = " + text::fixed(*network.s0(), 3) + " for readings of sd " + sd + " mGal\n";
        if (!*passes) {
            text += "  the scatter of the readings agrees with reading_sd_mgal = " +
                    text::fixed(result.score.s_mgal.value(), 3) + "; first look for a fault\n";
        }
    }
    text += "u of the stations: a priori (readings of sd " + sd +
            " mGal); times s0, a posteriori: stations.csv\n";
    const ReferenceCheck check = check_references(result);
    if (check.station_count > 0) {
        text += "stations whose reference is known but not held: " +
                std::to_string(check.station_count) + ", off by " + text::fixed(check.rms_mgal, 3) +
                " mGal rms (not in sample)\n";
    }
    return text;
}

Json network_json(const SurveyCorrection& result) {
    if (!result.network) return nullptr;
    const NetworkAdjustment& network = *result.network;
    const auto passes = network.passes_global_test();
    const auto s0 = network.s0();
    const ReferenceCheck check = check_references(result);
    Json json;
    json["datum_sd_mgal"] = result.options.network.datum_sd_mgal;
    json["drift_degree"] = result.options.network.drift_degree;
    json["unknowns"] = network.unknowns.size();
    json["dof"] = network.dof;
    json["weighted_square"] = network.weighted_square;
    json["global_test"] = {{"alpha", kGlobalTestAlpha},
                           {"low", network.chi_square_low},
                           {"high", network.chi_square_high},
                           {"passed", passes ? Json(*passes) : Json(nullptr)}};
    json["s0"] = s0 ? Json(*s0) : Json(nullptr);
    json["u_gravity"] = "a priori";
    json["references_not_held"] = {
        {"stations", check.station_count},
        {"rms_mgal", check.station_count > 0 ? Json(check.rms_mgal) : Json(nullptr)}};
    json["rows"] = Json::array();
    for (const NetworkRow& row : network.rows) {
        json["rows"].push_back({{"row", row.label},
                                {"residual", row.residual},
                                {"sd", row.sd},
                                {"redundancy", row.redundancy}});
    }
    return json;
}

}  // namespace a351::corrector
