#pragma once
/// @file
/// joint.json and the sentences about several surveys in one adjustment.

#include <string>
#include <variant>
#include <vector>

#include "corrector/model/joint_adjustment.hpp"
#include "corrector/result/joint_table.hpp"

namespace a351::corrector::result {

/// The adjustment of several surveys, or the reason why there is none.
using JointResult = std::variant<model::JointAdjustment, text::Message>;

/// Returns the content of joint.json: corrector/result/table-format.md.  Test:
/// tests/system/joint_surveys.py.
[[nodiscard]] std::string joint_json(const JointResult& joint, const JointTables& tables);

/// Returns how the joint values were made: the adjustment, the split of the placement, and the
/// factor of enlarged uncertainties; or why there are none.  In the language of this program.
[[nodiscard]] std::vector<std::string> joint_sentences(const JointResult& joint);

}  // namespace a351::corrector::result
