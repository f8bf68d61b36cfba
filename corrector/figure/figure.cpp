#include "corrector/figure/figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {

std::string source_of(const std::string& figure, std::size_t block) {
    return fmt::format("'{}.dat' index {}", figure, block);
}

std::string Figure::add(const std::string& title, const std::string& lines) {
    if (lines.empty()) return {};
    data += fmt::format("{}# {}\n{}", block_count > 0 ? "\n\n" : "", title, lines);
    return source_of(name, block_count++);
}

void Figure::plot(const std::string& title, const std::string& lines, Series series,
                  std::size_t panel) {
    series.source = add(title, lines);
    if (!lines.empty()) panels.at(panel).series.push_back(std::move(series));
}

std::string data_line(std::string_view decimals, std::initializer_list<double> numbers,
                      const std::string& end) {
    std::string line;
    for (std::size_t i = 0; const double number : numbers) {
        const int digits = decimals.at(i++) - '0';
        line += (std::isfinite(number) ? text::fixed(number, digits) : "NaN") + ' ';
    }
    return line + end;
}

double instant(UtcTime time) { return seconds_between(UtcTime{}, time); }

std::string as_published(const std::string& number, const std::string& value) {
    return value.empty() ? text::tr(" (Publication's Fig. {}.)", number)
                         : text::tr(" (Publication's Fig. {}; value there: {}.)", number, value);
}

std::string without_room(const std::vector<std::string>& names) {
    std::vector<std::string> once;
    for (const std::string& name : names)
        if (std::ranges::find(once, name) == once.end()) once.push_back(name);
    return once.empty() ? "" : text::tr(" No room for the names of: {}.", text::joined(once));
}

double round_step(double limit) {
    const double power = std::pow(10.0, std::floor(std::log10(limit)));
    for (const double step : {5.0, 2.0}) {
        if (step * power <= limit) return step * power;
    }
    return power;
}

}  // namespace a351::corrector::figure
