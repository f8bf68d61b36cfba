#include "corrector/reduction/air_pressure.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/reading/survey_row.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::reduction {

std::string PressureChannel::name() const {
    return fmt::format("{}.{}.{}.{}", codes.network, codes.station, codes.location, channel);
}

std::vector<std::filesystem::path> PressureChannel::files(UtcTime from, UtcTime to) const {
    return archive::day_files(archive, codes, channel, from, to);
}

std::optional<PressureChannel> pressure_channel(const std::string& name) {
    std::vector<std::string> parts{""};
    for (const char letter : name) {
        if (letter == '.')
            parts.emplace_back();
        else
            parts.back() += letter;
    }
    if (parts.size() != 4) return std::nullopt;
    PressureChannel channel;
    channel.codes.network = parts[0];
    channel.codes.station = parts[1];
    channel.codes.location = parts[2];
    channel.channel = parts[3];
    const auto is_code = [](char letter) {
        return (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9');
    };
    if (!journal::are_valid(channel.codes) || parts[3].size() != 3 || parts[3][1] != 'D' ||
        !std::ranges::all_of(parts[3], is_code))
        return std::nullopt;
    return channel;
}

AirPressure AirPressure::read(const PressureChannel& channel, UtcTime from, UtcTime to,
                              std::vector<text::Message>& warnings) {
    AirPressure pressure;
    std::size_t bad_count = 0;
    text::Message first_bad;
    for (const archive::Segment& segment :
         archive::read_channel(channel.archive, channel.codes, channel.channel, from, to).segments)
        for (std::size_t i = 0; i < segment.counts.size(); ++i) {
            const UtcTime time = segment.time_of(i);
            if (!pressure.times_.empty() && time <= pressure.times_.back()) continue;
            const double hpa = static_cast<double>(segment.counts[i]) / channel.counts_per_hpa;
            if (!(hpa >= reading::kLeastPressure_hpa && hpa <= reading::kGreatestPressure_hpa)) {
                if (bad_count++ == 0)
                    first_bad =
                        text::message("{} hPa at {}", text::fixed(hpa, 2), to_rfc3339(time));
                continue;
            }
            pressure.times_.push_back(time);
            pressure.values_hpa_.push_back(hpa);
        }
    if (pressure.times_.empty() && bad_count > 0)
        throw InputError(fmt::format(
            "{}: {}: not a pressure on the ground, like all others; allowed: {} to {}, with the "
            "right pressure_counts_per_hpa",
            channel.name(), first_bad, text::fixed(reading::kLeastPressure_hpa, 0),
            text::fixed(reading::kGreatestPressure_hpa, 0)));
    if (pressure.times_.size() < 2)
        throw InputError(fmt::format(
            "{}: no samples in {} between {} and {}; allowed: a channel with samples in the survey",
            channel.name(), channel.archive.string(), to_rfc3339(from), to_rfc3339(to)));
    if (bad_count > 0)
        warnings.push_back(text::message(
            "{}: samples that are no pressure on the ground are left out: {}, the first {}",
            channel.name(), bad_count, first_bad));
    return pressure;
}

AirPressure AirPressure::read(const std::filesystem::path& file) {
    const text::CsvTable table = text::read_csv(file);
    AirPressure pressure;
    pressure.times_ = table.ascending_times("time");
    for (std::size_t row = 0; row < table.row_count(); ++row)
        pressure.values_hpa_.push_back(table.number(
            row, "pressure_hpa", reading::kLeastPressure_hpa, reading::kGreatestPressure_hpa));
    if (pressure.times_.size() < 2)
        throw InputError(file.string() + ": too few rows; allowed: 2 or more");
    return pressure;
}

std::optional<double> AirPressure::at(UtcTime time) const {
    if (time < times_.front() || time > times_.back()) return std::nullopt;
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const auto i = static_cast<std::size_t>(after - times_.begin());
    if (times_[i] - times_[i - 1] > kLongestPressureStep) return std::nullopt;
    const double share =
        seconds_between(times_[i - 1], time) / seconds_between(times_[i - 1], times_[i]);
    return values_hpa_[i - 1] + share * (values_hpa_[i] - values_hpa_[i - 1]);
}

}  // namespace a351::corrector::reduction
