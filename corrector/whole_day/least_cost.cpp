#include "corrector/whole_day/least_cost.hpp"

#include <nlopt.h>

#include <algorithm>
#include <memory>

namespace a351::corrector::whole_day {

std::vector<double> least_cost_point(const std::function<double(const std::vector<double>&)>& cost,
                                     std::vector<double> start, bool is_nearby,
                                     const SearchLimits& limits) {
    struct Request {
        const std::function<double(const std::vector<double>&)>& cost;
        std::vector<double> point;
    } request{cost, start};
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(
        nlopt_create(is_nearby ? NLOPT_LN_BOBYQA : NLOPT_LN_SBPLX,
                     static_cast<unsigned>(start.size())),
        &nlopt_destroy);
    const auto cost_of = [](unsigned count, const double* at, double*, void* of) {
        auto& self = *static_cast<Request*>(of);
        std::transform(at, at + count, self.point.begin(), search_point);
        return search_cost(self.cost(self.point));
    };
    nlopt_set_min_objective(search.get(), cost_of, &request);
    nlopt_set_lower_bounds1(search.get(), -limits.farthest);
    nlopt_set_upper_bounds1(search.get(), limits.farthest);
    nlopt_set_initial_step1(search.get(), limits.first_step);
    nlopt_set_xtol_abs1(search.get(), limits.tolerance);
    nlopt_set_maxeval(search.get(), limits.most_costs);
    double least = 0.0;
    nlopt_optimize(search.get(), start.data(), &least);
    for (double& value : start) value = search_point(value);
    return start;
}

}  // namespace a351::corrector::whole_day
