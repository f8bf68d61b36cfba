#include "corrector/reading/decimated_axes.hpp"

namespace a351::corrector::reading {
namespace {

TimeSeries<MilliGal> in_milligal(const TimeSeries<StandardGravity>& series) {
    std::vector<double> values_mgal = series.values();
    for (double& value : values_mgal) value *= kMilliGalPerStandardGravity;
    return {series.start(), series.rate(), std::move(values_mgal)};
}

}  // namespace

DecimatedAxes decimate_axes(const OccupationRecord& record) {
    const signal::DecimationFilter filter = signal::design_decimation(kDecimationFactor);
    return {signal::decimate(record.x, filter, kDecimationStages),
            signal::decimate(record.y, filter, kDecimationStages),
            signal::decimate(record.z, filter, kDecimationStages)};
}

TimeSeries<MilliGal> gravity_series(const OccupationRecord& record, const DecimatedAxes& axes,
                                    NormOrder order) {
    if (order == NormOrder::decimate_first)
        return in_milligal(signal::norm(axes.x, axes.y, axes.z));
    return in_milligal(signal::decimate(signal::norm(record.x, record.y, record.z),
                                        signal::design_decimation(kDecimationFactor),
                                        kDecimationStages));
}

}  // namespace a351::corrector::reading
