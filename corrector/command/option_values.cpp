#include "corrector/command/option_values.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector {

UtcTime instant_option(std::string_view name, const std::string& text) {
    const auto time = parse_rfc3339(text);
    if (!time) {
        throw InputError(std::string(name) + " = " + text +
                         ": not an instant; allowed: YYYY-MM-DDThh:mm:ss with Z or +hh:mm");
    }
    return *time;
}

double number_option(std::string_view name, double value, double low, double high) {
    if (value >= low && value <= high) return value;
    throw InputError(std::string(name) + " = " + text::shortest(value) +
                     ": out of range; allowed: " + text::shortest(low) + " to " +
                     text::shortest(high));
}

}  // namespace a351::corrector
