#pragma once
/// @file
/// The files and the text of a design (design-format.md).
///
///     const Design design = make_design(plan, sites, unit);
///     text::write_together(out, design_files(design, inputs));
///     std::cout << design_text(design);

#include <string>
#include <vector>

#include "corrector/design/alternatives.hpp"
#include "corrector/design/expected_errors.hpp"
#include "corrector/design/plan.hpp"
#include "corrector/design/planned_unit.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::design {

/// A plan with its uncertainties and what would improve it.
struct Design {
    Plan plan;
    PlannedUnit unit;
    ExpectedErrors errors;
    std::vector<Alternative> alternatives;  ///< The best first.
};

/// Computes a design.
/// @param plan, sites  as expected_errors().
[[nodiscard]] Design make_design(const Plan& plan, const std::vector<text::Site>& sites,
                                 const PlannedUnit& unit);

/// Returns design.csv, differences.csv and design.json.
[[nodiscard]] std::vector<text::NamedText> design_files(const Design& design,
                                                        const std::vector<text::InputFile>& inputs);

/// Returns the content of design.json.
[[nodiscard]] std::string design_json(const Design& design,
                                      const std::vector<text::InputFile>& inputs);

/// Returns the tables of stations and alternatives for people, with the hours in total.
[[nodiscard]] std::string design_text(const Design& design);

}  // namespace a351::corrector::design
