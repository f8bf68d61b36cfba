#include "corrector/result/network_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/or_null.hpp"

namespace a351::corrector::result {
namespace {

using Json = nlohmann::ordered_json;

/// Comparison of adjusted stations with references that the network does not hold.
struct ReferenceCheck {
    std::size_t station_count = 0;
    std::optional<double> rms_mgal = {};  ///< Absent without a station.
};

ReferenceCheck check_references(const model::SurveyCorrection& result,
                                const model::NetworkPart& network) {
    std::vector<double> differences_mgal;
    for (const model::StationValue& station : result.stations) {
        if (!network.holds(station.site) && !station.is_flagged_only && station.residual)
            differences_mgal.push_back(station.residual->value());
    }
    return {differences_mgal.size(), model::root_mean_square(differences_mgal)};
}

/// Returns the standard deviations of some rows, as " of sd 0.005 to 0.01 mGal"; empty without a row.
std::string deviations(const model::NetworkPart& network, std::size_t first, std::size_t count) {
    if (count == 0) return {};
    const auto [least, most] = std::ranges::minmax(std::span(network.rows).subspan(first, count),
                                                   {}, &model::NetworkRow::sd);
    return least.sd == most.sd ? fmt::format(" of sd {:.3g} mGal", least.sd)
                               : fmt::format(" of sd {:.3g} to {:.3g} mGal", least.sd, most.sd);
}

}  // namespace

std::string network_text(const model::SurveyCorrection& result) {
    const auto* const adjusted = result.as<model::NetworkPart>();
    if (adjusted == nullptr) return {};
    const model::NetworkPart& network = *adjusted;
    const std::size_t readings = network.reading_count, held = network.held_sites.size();
    std::string text = fmt::format(
        "network: {} rows (readings: {}; datum: {}{}; priors: {}), {} unknowns, dof = {}\n",
        network.rows.size(), readings, held, deviations(network, readings, held),
        network.rows.size() - readings - held, network.unknown_count, network.dof);
    const std::string sd = deviations(network, 0, readings);
    const bool have_own_sd = std::ranges::any_of(result.rows, [](const model::CorrectedRow& row) {
        return row.row.u_average != MilliGal(0.0);
    });
    if (const auto passes = network.passes_global_test()) {
        text += fmt::format("global test: v'Wv = {}, at most {}: {}; s0 = {} for readings{}\n",
                            text::fixed(network.weighted_square, 2),
                            text::fixed(network.chi_square_high, 2), *passes ? "passed" : "FAILED",
                            text::fixed(*network.s0(), 3), sd);
        const std::string scatter =
            have_own_sd
                ? fmt::format("is {:.2g} times what they state", *network.s0())
                : fmt::format("agrees with reading_sd_mgal = {:.2g}", result.score.s_mgal.value());
        if (!*passes)
            text +=
                fmt::format("  the scatter of the readings {}; first look for a fault\n", scatter);
        if (network.scatters_less_than_stated())
            text += fmt::format(
                "  the readings scatter less than stated (v'Wv below {}): their scatter {}\n",
                text::fixed(network.chi_square_low, 2), scatter);
        if (!*passes)
            text +=
                "u in the first table is a posteriori, times s0; that of stations.csv a priori\n";
    }
    const ReferenceCheck check = check_references(result, network);
    if (check.rms_mgal) {
        text += fmt::format(
            "stations whose reference is known but not held: {}, off by {} mGal rms (not in "
            "sample)\n",
            check.station_count, text::fixed(*check.rms_mgal, 3));
    }
    return text;
}

Json network_json(const model::SurveyCorrection& result) {
    const auto* const adjusted = result.as<model::NetworkPart>();
    if (adjusted == nullptr) return nullptr;
    const model::NetworkPart& network = *adjusted;
    const auto passes = network.passes_global_test();
    const ReferenceCheck check = check_references(result, network);
    Json json;
    json["datum_sd_mgal"] = result.options.network.datum_sd_mgal;
    json["drift_degree"] = result.options.network.drift_degree;
    json["unknowns"] = network.unknown_count;
    json["dof"] = network.dof;
    json["weighted_square"] = network.weighted_square;
    json["global_test"] = {{"alpha", model::kGlobalTestAlpha},
                           {"low", network.chi_square_low},
                           {"high", network.chi_square_high},
                           {"passed", text::or_null(passes)}};
    json["s0"] = text::or_null(network.s0());
    json["u_gravity"] = "a priori";
    json["references_not_held"] = {{"stations", check.station_count},
                                   {"rms_mgal", text::or_null(check.rms_mgal)}};
    json["rows"] = Json::array();
    for (const model::NetworkRow& row : network.rows) {
        json["rows"].push_back({{"row", row.label},
                                {"residual", row.residual},
                                {"sd", row.sd},
                                {"redundancy", row.redundancy}});
    }
    return json;
}

}  // namespace a351::corrector::result
