#include "corrector/command/record_apply.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {
namespace {

/// Returns whether the calibration was measured from a file of the record, metadata aside.
bool is_in_sample(const LongRecord& record, const Calibration& calibration) {
    return std::ranges::any_of(record.inputs, [&](const text::InputFile& input) {
        return input.role != "metadata" &&
               std::ranges::any_of(calibration.data, [&](const CalibrationData& data) {
                   return data.name == input.name &&
                          data.sha256 == text::sha256_of_file(input.path);
               });
    });
}

}  // namespace

void apply_to(RecordResult& result, const std::string& file) {
    const Calibration calibration = read_calibration(file);
    const std::string& unit = result.segment().serial_number;
    if (!unit.empty() && unit != calibration.serial_number)
        throw InputError(file + ": serial_number = " + calibration.serial_number +
                         ": the record is of unit " + unit + "; allowed: a calibration of " + unit);
    if (!calibration.thermal)
        throw InputError(file + ": thermal is missing; allowed: a calibration from a long record");
    AppliedCalibration applied =
        apply_calibration(*calibration.thermal, result.segment(), result.analysis,
                          longest_of_band_s(result.options.cycle_s));
    applied.origin =
        "calibration of unit " + calibration.serial_number + " (" + calibration.program +
        ", from " + to_rfc3339(calibration.valid_from) + "), " +
        (is_in_sample(result.record, calibration) ? "in sample: it was measured from this record"
                                                  : "measured from other records");
    if (unit.empty())
        applied.remarks.emplace_back(
            "the record has no serial number: it was not checked that the calibration belongs to "
            "this unit");
    const UtcTime end = calibration.valid_to.value_or(UtcTime::max());
    if (result.segment().start < calibration.valid_from || result.segment().end > end)
        applied.remarks.emplace_back("the record is not within the calibration's validity");
    result.record.inputs.push_back(text::describe_input("calibration", file));
    result.applied = std::move(applied);
}

}  // namespace a351::corrector
