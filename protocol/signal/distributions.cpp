#include "protocol/signal/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace a351::signal {

using boost::math::chi_squared, boost::math::complement, boost::math::students_t;

double students_t_quantile(double dof, double p) { return quantile(students_t(dof), p); }
double students_t_exceedance(double dof, double t) { return cdf(complement(students_t(dof), t)); }

double chi_square_quantile(double dof, double p) { return quantile(chi_squared(dof), p); }
double chi_square_upper_quantile(double dof, double q) {
    return quantile(complement(chi_squared(dof), q));
}
double chi_square_exceedance(double dof, double x) { return cdf(complement(chi_squared(dof), x)); }

}  // namespace a351::signal
