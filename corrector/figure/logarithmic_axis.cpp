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
    for (std::size_t block = 0, empty = 0; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        empty = line.empty() ? empty + 1 : 0;
        if (empty == 2) ++block;
        if (line.empty() || line[0] == '#' || source != source_of(figure.name, block)) continue;
        row.clear();
        double number = 0.0;
        for (const char* at = line.data(); at < line.data() + line.size(); ++at) {
            const auto end = std::from_chars(at, line.data() + line.size(), number).ptr;
            if (end == at) break;
            row.push_back(number);
            at = end;
        }
        use(row);
    }
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
        if (axis.scale != Scale::logarithmic || !std::isnan(axis.range[0]) || low_ > high_) return;
        axis.range = {std::pow(10.0, low_), std::pow(10.0, std::max(high_, low_ + 1.0))};
    }

private:
    double low_ = INFINITY, high_ = -INFINITY;
};

}  // namespace

void set_decades(Panel& panel, const Figure& figure) {
    Decades x, y, colours;
    if (std::ranges::none_of(std::array{panel.x, panel.y, panel.colours}, [](const Axis& axis) {
            return axis.scale == Scale::logarithmic && std::isnan(axis.range[0]);
        }))
        return;
    for (const Series& series : panel.series)
        for_each_row(figure, series.source, [&](const std::vector<double>& row) {
            const auto value = [&](std::size_t column) {
                const auto place = static_cast<std::size_t>(series.columns[column] - 1);
                return place < row.size() ? row[place] : kFromData;
            };
            x.add(value(0));
            for (std::size_t k = 1; k < series.columns.size(); ++k) y.add(value(k));
            if (series.colour == Colour::by_value) colours.add(value(series.columns.size() - 1));
        });
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
