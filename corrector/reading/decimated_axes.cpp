#include "corrector/reading/decimated_axes.hpp"

namespace a351::corrector {
namespace {

TimeSeries<MilliGal> in_milligal(const TimeSeries<StandardGravity>& series) {
    std::vector<double> values_mgal = series.values();
    for (double& value : values_mgal) value *= kMilliGalPerStandardGravity;
    return {series.start(), series.rate(), std::move(values_mgal)};
}

}  // namespace

DecimatedAxes decimate_axes(const OccupationRecord& record) {
    const DecimationFilter filter = design_decimation(kDecimationFactor);
    return {decimate(record.x, filter, kDecimationStages),
            decimate(record.y, filter, kDecimationStages),
            decimate(record.z, filter, kDecimationStages)};
}

TimeSeries<MilliGal> gravity_series(const OccupationRecord& record, const DecimatedAxes& axes,
                                    NormOrder order) {
    if (order == NormOrder::decimate_first) return in_milligal(norm(axes.x, axes.y, axes.z));
    return in_milligal(decimate(norm(record.x, record.y, record.z),
                                design_decimation(kDecimationFactor), kDecimationStages));
}

}  // namespace a351::corrector
