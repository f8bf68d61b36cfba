// Law: latitude, longitude and height of a station cannot be given in another order.
#include "corrector/tide/earth_tide.hpp"

a351::corrector::tide::Station summit(a351::Degrees latitude, a351::Degrees longitude,
                                      a351::Metres height) {
#ifdef A351_LEGAL
    return {latitude, longitude, height};
#else
    return {height, latitude, longitude};
#endif
}
