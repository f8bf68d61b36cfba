/// @file
/// The last day of data from the archive, for a live record that begins.

#include <algorithm>
#include <string>
#include <utility>

#include "daemon/live/live_record.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/channel_code.hpp"

namespace a351::daemon::live {
namespace {

constexpr Nanoseconds kPast = std::chrono::hours(24);  ///< Time loaded at 50 Hz and below.
constexpr int kRateOfPast_hz = 50;       ///< Above this rate the same number of samples is loaded.
constexpr int kPieces = 4;               ///< Number of pieces, 17 MB each.
constexpr double kDegcPerCount = 0.001;  ///< Scale of the ovens' channels.

/// Goes through a channel sample by sample.
class Cursor {
public:
    explicit Cursor(archive::ChannelData data) : data_(std::move(data)) {}

    [[nodiscard]] bool is_at_end() const { return segment_ == data_.segments.size(); }
    [[nodiscard]] std::int32_t counts() const { return data_.segments[segment_].counts[sample_]; }
    [[nodiscard]] UtcTime time() const {
        const archive::Segment& segment = data_.segments[segment_];
        const auto& anchor = segment.anchors[anchor_];
        return anchor.time +
               from_seconds(static_cast<double>(sample_ - anchor.offset) / segment.rate_hz);
    }
    void next() {
        const archive::Segment& segment = data_.segments[segment_];
        if (++sample_ == segment.counts.size()) {
            ++segment_;
            sample_ = anchor_ = 0;
        } else if (anchor_ + 1 < segment.anchors.size() &&
                   segment.anchors[anchor_ + 1].offset == sample_) {
            ++anchor_;
        }
    }

    /// Moves to the first sample that is not earlier than `time` by more than `tolerance`.
    /// @return true if this sample is not later by more than `tolerance` either.
    bool find(UtcTime time, Nanoseconds tolerance) {
        while (!is_at_end() && this->time() < time - tolerance) next();
        return !is_at_end() && this->time() <= time + tolerance;
    }

private:
    archive::ChannelData data_;
    std::size_t segment_ = 0, sample_ = 0, anchor_ = 0;
};

void take_samples(const std::filesystem::path& archive, const journal::StationCodes& codes,
                  UtcTime from, UtcTime to, Record& record) {
    const auto cursor = [&](const std::string& instrument_and_axis) {
        return Cursor(archive::read_channel(
            archive, codes, archive::channel_code(record.rate_hz(), instrument_and_axis), from,
            to));
    };
    std::array cursors{cursor("N" + codes.axes[0]), cursor("N" + codes.axes[1]),
                       cursor("N" + codes.axes[2]), cursor("K1")};
    const Nanoseconds half = from_seconds(0.5 / record.rate_hz());
    PlacedSample sample;
    for (; !cursors[0].is_at_end(); cursors[0].next(), ++sample.index) {
        sample.time = cursors[0].time();
        bool is_whole = true;
        for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel) {
            is_whole = is_whole && cursors[channel].find(sample.time, half);
            if (is_whole) sample.counts[channel] = cursors[channel].counts();
        }
        if (is_whole) record.take(sample);
    }
}

void take_oven(const std::filesystem::path& archive, const journal::StationCodes& codes,
               journal::OvenPlace place, UtcTime from, UtcTime to, Record& record) {
    const auto cursor = [&](std::string_view channel) {
        return Cursor(archive::read_channel(archive, codes, std::string(channel), from, to));
    };
    const bool is_inner = place == journal::OvenPlace::inner;
    Cursor value = cursor(is_inner ? archive::kOvenTemperature : archive::kOuterTemperature),
           set_point = cursor(is_inner ? archive::kOvenSetPoint : archive::kOuterSetPoint);
    for (; !set_point.is_at_end(); set_point.next()) {
        OvenPoint point{set_point.time(), std::nullopt, DegC(kDegcPerCount * set_point.counts()),
                        place};
        if (value.find(point.time, std::chrono::milliseconds(500)))
            point.process_value = DegC(kDegcPerCount * value.counts());
        record.take(point);
    }
}

}  // namespace

std::optional<UtcTime> last_exchange(const std::vector<events::Event>& log) {
    const auto exchange = std::find_if(log.rbegin(), log.rend(), [](const events::Event& event) {
        return event.type == "other_unit";
    });
    return exchange == log.rend() ? std::nullopt : std::optional(exchange->utc);
}

void take_archived_past(const std::filesystem::path& archive, const journal::StationCodes& codes,
                        UtcTime now, Record& record) {
    const Nanoseconds piece =
        kPast * kRateOfPast_hz / std::max(record.rate_hz(), kRateOfPast_hz) / kPieces;
    for (int left = kPieces; left > 0; --left)
        take_samples(archive, codes, now - left * piece, now - (left - 1) * piece, record);
    record.end_of_history();
    for (const auto place : {journal::OvenPlace::inner, journal::OvenPlace::outer})
        take_oven(archive, codes, place, now - kPast, now, record);
}

}  // namespace a351::daemon::live
