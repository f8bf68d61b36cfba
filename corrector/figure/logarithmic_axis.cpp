#include "corrector/figure/logarithmic_axis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {
namespace {

/// Calls `use` with the numbers of each line of a figure's block.
template <class Use>
void for_each_row(const Figure& figure, const std::string& source, const Use& use) {
    std::string_view rest = figure.data;
    std::vector<double> row;
    bool is_wanted = source == source_of(figure.name, 0);
    for (std::size_t block = 0, empty = 0; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        empty = line.empty() ? empty + 1 : 0;
        if (empty == 2) is_wanted = source == source_of(figure.name, ++block);
        if (line.empty() || line[0] == '#' || !is_wanted) continue;
        row.clear();
        double number = 0.0;
        const char* const line_end = line.data() + line.size();
        for (const char* at = line.data(); at < line_end; ++at) {  // a blank follows each number
            const char* const number_end = std::from_chars(at, line_end, number).ptr;
            if (number_end == at || number_end == line_end || *number_end != ' ') break;
            row.push_back(number);
            at = number_end;
        }
        use(row);
    }
}

bool follows_from_data(const Axis& axis) {
    return axis.scale == Scale::logarithmic &&
           (std::isnan(axis.range[0]) || std::isnan(axis.range[1]));
}

/// The powers of ten around values.
class Decades {
public:
    void add(double value) {
        if (!std::isfinite(value) || value <= 0.0) return;
        low_ = std::min(low_, std::floor(std::log10(value)));
        high_ = std::max(high_, std::ceil(std::log10(value)));
    }

    void set(Axis& axis) const {
        if (!follows_from_data(axis) || low_ > high_) return;
        if (std::isnan(axis.range[0])) axis.range[0] = std::pow(10.0, low_);
        if (std::isnan(axis.range[1])) axis.range[1] = std::pow(10.0, std::max(high_, low_ + 1.0));
    }

private:
    double low_ = INFINITY, high_ = -INFINITY;
};

}  // namespace

void set_decades(Panel& panel, const Figure& figure) {
    Decades x, y, colours;
    if (std::ranges::none_of(std::array{panel.x, panel.y, panel.colours}, follows_from_data))
        return;
    for (const Series& series : panel.series) {
        // The columns of a look: figure.hpp.
        const std::size_t count = series.columns.size();
        const bool has_u = count == 3 && series.look != Look::area;
        const std::size_t values_of_y = series.look == Look::tiles || series.is_right ? 0
                                        : has_u                                       ? 2
                                                                                      : count;
        for_each_row(figure, series.source, [&](const std::vector<double>& row) {
            const auto value = [&](std::size_t column) {
                const auto place = static_cast<std::size_t>(series.columns[column] - 1);
                return place < row.size() ? row[place] : kFromData;
            };
            x.add(value(0));
            for (std::size_t k = 1; k < values_of_y; ++k) y.add(value(k));
            if (series.colour == Colour::by_value) colours.add(value(count - 1));
        });
    }
    x.set(panel.x);
    y.set(panel.y);
    colours.set(panel.colours);
}

std::string logarithmic_ticks(const std::array<double, 2>& range) {
    constexpr double kFewDigits = 5.0, kTwoDecades = 100.0, kThreeDecades = 1000.0,
                     kRounding = 1.0 + 1e-9;
    const double ratio = range[1] / range[0];
    if (std::isnan(ratio) || ratio >= kThreeDecades) return {};
    std::vector<std::string> ticks;
    std::size_t numbers = 0;
    for (double power = std::pow(10.0, std::floor(std::log10(range[0]))); power <= range[1];
         power *= 10.0)
        for (int digit = 1; digit <= 9; ++digit) {
            const double value = digit * power;
            if (value * kRounding < range[0] || value > range[1] * kRounding) continue;
            const bool has_number = digit == 1 || ratio < kFewDigits ||
                                    (ratio < kTwoDecades && (digit == 2 || digit == 5));
            numbers += has_number ? 1 : 0;
            const std::string text = fmt::format("{:.6g}", value);
            ticks.push_back(has_number ? text : "'' " + text + " 1");
        }
    return numbers < 2 ? std::string() : '(' + text::joined(ticks) + ')';
}

}  // namespace a351::corrector::figure
