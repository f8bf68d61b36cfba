#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/station/station_xml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

namespace a351 {

/// A made-up morning on disk: four stays at three sites, across midnight, as miniSEED, StationXML,
/// sites.csv and occupations.csv. The third stay is flagged.
class Morning {
public:
    static constexpr double kTrueRate_hz = 50.002;  ///< True rate, 40 ppm off the nominal 50 Hz.
    static constexpr std::chrono::seconds kStay{150};
    static constexpr std::chrono::seconds kCycle{240};  ///< Stay and way to the next site.
    static constexpr double kConstant_mgal = 1850.0;
    static constexpr double kSlope_mgal_per_degc = -30.0;
    static constexpr double kTilt_g = 0.01;
    inline static const UtcTime kBegin = parse_rfc3339("2020-05-01T23:50:00Z").value();
    inline static const std::vector<std::string> kSites{"B", "S1", "S2", "B"};
    inline static const std::vector<double> kGravity_mgal{979800.0, 979850.0, 979760.0, 979800.0};

    /// Before the last stay a wrong profile begins: half of the acceleration, or 500 degC more.  Or the
    /// sensor is exchanged before the third stay: ten seconds have no samples, and the readings
    /// of the second one are kOther_mgal higher.
    enum class Sensors { one, exchanged, wrong_scale, wrong_temperature };
    static constexpr std::chrono::seconds kExchange{480}, kPause{10};
    static constexpr double kOther_mgal = 1000.0;

    explicit Morning(Sensors sensors = Sensors::one) : sensors_(sensors) {
        station::Description description;
        description.start = kBegin;
        description.profile = "A351";
        description.output_rate_hz = 50;
        description.filter = "k512_fc9";
        if (sensors == Sensors::exchanged) description.serial_number = "00000001";
        folder_.write("data/metadata/station.xml", station::to_station_xml(description));
        if (sensors == Sensors::exchanged) {
            description.serial_number = "00000777";
            description.start = kBegin + kExchange;
            folder_.write("data/metadata/station.xml",
                          *station::extend_station_xml(folder_.path() / "data/metadata/station.xml",
                                                       description));
        }
        const auto station =
            station::read_station_xml(folder_.path() / "data/metadata/station.xml");
        for (const auto& channel : station.channels)
            if (!archive::is_derived(channel.code)) write_channel(channel);
        folder_.write("sites.csv",
                      "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                      "B,140.1,36.2,500,979800\nS1,140.0,36.1,200,979850\n"
                      "S2,140.2,36.3,800,979760\n");
        std::string rows = "site,occupation,start_utc,end_utc,used,note\n";
        for (std::size_t i = 0; i < kSites.size(); ++i) {
            const UtcTime start = start_of(i);
            rows += kSites[i] + (i == 3 ? ",2," : ",1,") + to_rfc3339(start) + ',' +
                    to_rfc3339(start + kStay) + (i == 2 ? ",0,\n" : ",,\n");
        }
        folder_.write("occupations.csv", rows);
    }

    static double temperature_degc(double seconds) {
        return 42.3 + 0.4 * std::sin(seconds / 900.0);
    }

    /// Returns the reading without the tide, in mGal, at the sensor's site of that time.
    static double reading_mgal(double seconds) {
        const auto cycle = static_cast<std::size_t>(seconds / 240.0);
        return kGravity_mgal[std::min(cycle, kSites.size() - 1)] + kConstant_mgal +
               kSlope_mgal_per_degc * (temperature_degc(seconds) - 42.6);
    }

    [[nodiscard]] static UtcTime start_of(std::size_t i) {
        return kBegin + static_cast<int>(i) * kCycle + std::chrono::seconds(20);
    }

    [[nodiscard]] static events::Event start_event(std::size_t i) {
        return {"start", start_of(i), {}, {}, {{"site", kSites[i]}}};
    }

    [[nodiscard]] static events::Event stop_event(std::size_t i) {
        return {"stop", start_of(i) + kStay, {}, {}, {}};
    }

    void log(const events::Event& event) const {
        events::append_event(files::posix_files(), folder_.path() / "data/events", event);
    }

    [[nodiscard]] const test::TemporaryDirectory& folder() const { return folder_; }

private:
    void write_channel(const station::ChannelScale& channel) {
        std::vector<std::int32_t> counts;
        const auto total =
            static_cast<std::size_t>(static_cast<double>(kSites.size()) * 240.0 * kTrueRate_hz);
        const double g_mgal = kMilliGalPerStandardGravity;
        for (std::size_t i = 0; i < total; ++i) {
            const double seconds = static_cast<double>(i) / kTrueRate_hz;
            double value = temperature_degc(seconds);
            if (channel.code == "BN1") value = kTilt_g * g_mgal * 1e-5;
            if (channel.code == "BN2") value = 0.0;
            if (channel.code == "BNZ") {
                const bool is_other =
                    sensors_ == Sensors::exchanged && from_seconds(seconds) >= kExchange - kPause;
                const double reading = reading_mgal(seconds) + (is_other ? kOther_mgal : 0.0);
                value = std::sqrt(reading * reading - kTilt_g * kTilt_g * g_mgal * g_mgal) * 1e-5;
            }
            const bool is_wrong = from_seconds(seconds) >= 3 * kCycle;
            if (is_wrong && sensors_ == Sensors::wrong_temperature && channel.code == "BK1")
                value += 500.0;
            if (is_wrong && sensors_ == Sensors::wrong_scale && channel.code != "BK1") value *= 0.5;
            counts.push_back(
                static_cast<std::int32_t>(std::llround((value - channel.offset) / channel.gain)));
        }
        archive::SdsWriter writer(files::posix_files(), folder_.path() / "data/archive", {});
        std::size_t at = 0;
        while (at < counts.size()) {
            archive::RecordHeader header;
            header.network = "XX";
            header.station = "A351";
            header.location = "00";
            header.channel = channel.code;
            header.start = kBegin + from_seconds(static_cast<double>(at) / kTrueRate_hz);
            header.nominal_rate = Hertz(50.0);
            if (sensors_ == Sensors::exchanged && is_in_pause(at)) {
                at = sample_at(kExchange);
                continue;
            }
            const std::size_t before_midnight =
                std::min(samples_before_midnight(at, counts.size()),
                         sensors_ == Sensors::exchanged && at < sample_at(kExchange)
                             ? sample_at(kExchange - kPause) - at
                             : counts.size());
            const auto packed =
                archive::pack_record(header, std::span(counts).subspan(at, before_midnight));
            writer.append(channel.code, packed);
            at += packed.sample_count;
        }
        writer.sync();
    }

    /// Returns the number of samples before midnight, 600 s after kBegin; no record crosses it.
    static std::size_t samples_before_midnight(std::size_t at, std::size_t count) {
        const auto first_after = static_cast<std::size_t>(std::ceil(600.0 * kTrueRate_hz));
        return at < first_after ? std::min(first_after, count) - at : count - at;
    }

    static std::size_t sample_at(std::chrono::seconds since_begin) {
        return static_cast<std::size_t>(
            std::ceil(static_cast<double>(since_begin.count()) * kTrueRate_hz));
    }
    static bool is_in_pause(std::size_t sample) {
        return sample >= sample_at(kExchange - kPause) && sample < sample_at(kExchange);
    }

    Sensors sensors_;
    test::TemporaryDirectory folder_;
};

}  // namespace a351
