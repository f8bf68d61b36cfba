#include "protocol/journal/journal_header_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/wire/device_profile.hpp"

namespace a351::journal {

namespace {

using Json = nlohmann::ordered_json;

/// Largest relative difference of a declared rate from the nominal one, as in records of the archive.
constexpr double kFarthestRate = 0.1;

Json clock_to_json(const timing::ClockReading& clock) {
    Json json = {{"raw_ns", clock.raw.time_since_epoch().count()},
                 {"boottime_ns", clock.boottime.count()},
                 {"realtime_ns", clock.realtime.time_since_epoch().count()},
                 {"synchronised", clock.is_synchronised},
                 {"max_error_us", clock.max_error_us},
                 {"estimated_error_us", clock.estimated_error_us}};
    if (clock.leap != timing::LeapSecond::none) json["leap"] = static_cast<int>(clock.leap);
    return json;
}

timing::ClockReading clock_from_json(const Json& json) {
    timing::ClockReading clock;
    clock.raw = RawTime(Nanoseconds(json.at("raw_ns").get<std::int64_t>()));
    clock.boottime = Nanoseconds(json.at("boottime_ns").get<std::int64_t>());
    clock.realtime = UtcTime(Nanoseconds(json.at("realtime_ns").get<std::int64_t>()));
    clock.is_synchronised = json.at("synchronised").get<bool>();
    clock.max_error_us = json.at("max_error_us").get<std::int64_t>();
    clock.estimated_error_us = json.at("estimated_error_us").get<std::int64_t>();
    const int leap = json.value("leap", 0);
    if (leap < 0 || leap > 2) throw std::invalid_argument("leap");
    clock.leap = static_cast<timing::LeapSecond>(leap);
    if (!is_in_range(clock)) throw std::invalid_argument("clock");
    return clock;
}

std::chrono::seconds oven_interval(const Json& json, const char* key) {
    const std::chrono::seconds interval(json.value(key, 1));
    if (interval < kShortestOvenInterval || interval > kLongestOvenInterval)
        throw std::invalid_argument(key);
    return interval;
}

Header header_from_json(const Json& json) {
    Header header;
    const auto session = SessionId::from_hex(json.at("session").get<std::string>());
    if (!session) throw std::invalid_argument("session");
    header.session = *session;
    header.boot_id = json.at("boot_id").get<std::string>();
    header.program_version = json.at("program_version").get<std::string>();
    header.codes.network = json.at("network").get<std::string>();
    header.codes.station = json.at("station").get<std::string>();
    header.codes.location = json.at("location").get<std::string>();
    header.codes.axes = json.at("axes").get<std::array<std::string, 3>>();
    if (!are_valid(header.codes)) throw std::invalid_argument("codes");
    header.profile = json.at("profile").get<std::string>();
    // A profile that cannot be read remains unknown.  The bytes of the stream are still whole.
    if (json.contains("profile_toml"))
        wire::add_recorded_profile(header.profile, json.at("profile_toml").get<std::string>());
    header.product_id = json.at("product_id").get<std::string>();
    header.serial_number = json.at("serial_number").get<std::string>();
    header.firmware = json.at("firmware").get<std::uint16_t>();
    header.is_device_assumed = json.value("device_assumed", false);
    const auto test = wire::start_up_test_named(json.value("start_up_test", "passed"));
    if (!test) throw std::invalid_argument("start_up_test");
    header.start_up_test = *test;
    header.port = json.value("port", "");
    header.output_rate_hz = json.at("output_rate_hz").get<int>();
    header.filter = json.at("filter").get<std::string>();
    header.burst_ctrl = json.at("burst_ctrl").get<std::uint16_t>();
    header.baud = json.at("baud").get<int>();
    if (json.contains("declared_rate_hz")) {
        header.declared_rate_hz = json.at("declared_rate_hz").get<double>();
        if (!(std::abs(*header.declared_rate_hz / header.output_rate_hz - 1.0) <= kFarthestRate))
            throw std::invalid_argument("declared_rate_hz");
    }
    header.oven_interval = oven_interval(json, "oven_interval_s");
    header.outer_oven_interval = oven_interval(json, "outer_oven_interval_s");
    header.record_age = std::chrono::seconds(json.value("record_age_s", kLongestRecordAge.count()));
    if (header.record_age < kShortestRecordAge || header.record_age > kLongestRecordAge)
        throw std::invalid_argument("record_age_s");
    header.clock = clock_from_json(json.at("clock"));
    if (json.contains("repeats")) {
        const Json& repeats = json.at("repeats");
        header.repeats = {repeats.at("segment").get<std::uint64_t>(),
                          repeats.at("sequence").get<std::uint32_t>()};
    }
    return header;
}

}  // namespace

std::string header_to_json(const Header& header) {
    Json json = {{"session", header.session.to_hex()},
                 {"boot_id", header.boot_id},
                 {"program_version", header.program_version},
                 {"network", header.codes.network},
                 {"station", header.codes.station},
                 {"location", header.codes.location},
                 {"axes", header.codes.axes},
                 {"profile", header.profile},
                 {"product_id", header.product_id},
                 {"serial_number", header.serial_number},
                 {"firmware", header.firmware},
                 {"output_rate_hz", header.output_rate_hz},
                 {"filter", header.filter},
                 {"burst_ctrl", header.burst_ctrl},
                 {"baud", header.baud}};
    const wire::DeviceProfile* const profile = wire::find_profile(header.profile);
    if (profile != nullptr && !profile->toml.empty()) json["profile_toml"] = profile->toml;
    if (header.is_device_assumed) json["device_assumed"] = true;
    if (header.start_up_test != wire::StartUpTest::passed)
        json["start_up_test"] = wire::to_text(header.start_up_test);
    if (!header.port.empty()) json["port"] = header.port;
    if (header.declared_rate_hz) json["declared_rate_hz"] = *header.declared_rate_hz;
    if (header.oven_interval != kShortestOvenInterval)
        json["oven_interval_s"] = header.oven_interval.count();
    if (header.record_age != kLongestRecordAge) json["record_age_s"] = header.record_age.count();
    if (header.outer_oven_interval != kShortestOvenInterval)
        json["outer_oven_interval_s"] = header.outer_oven_interval.count();
    json["clock"] = clock_to_json(header.clock);
    if (header.repeats) {
        json["repeats"] = {{"segment", header.repeats->segment},
                           {"sequence", header.repeats->sequence}};
    }
    // Product and serial number come from the device: a byte that is not UTF-8 must not stop the
    // journal.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Header> parse_header(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    try {
        return header_from_json(json);
    } catch (const Json::exception&) {
        return std::nullopt;
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

}  // namespace a351::journal
