/// @file
/// Configuration, calibration, scenario and fault script must be accepted, or refused by an
/// InputError of one line.

#include "daemon/config/config.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/unit/calibration.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/profile_reader.hpp"
#include "sim/line/fault_script.hpp"
#include "sim/scenario/scenario.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;

template <class Read>
void take_or_refuse(Read read) {
    try {
        read();
    } catch (const InputError& error) {
        fuzz::require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(fuzz::text_of(data, size));
    const auto file = fuzz::file_of(text, "input.toml");
    take_or_refuse([&] { (void)daemon::config::read_config(file); });
    take_or_refuse([&] { (void)unit::parse_calibration(text, "calibration.toml"); });
    take_or_refuse([&] { (void)wire::parse_profile(text, "mine", "mine.toml"); });
    take_or_refuse([&] { (void)sim::scenario::parse_scenario(text, "scenario.toml"); });
    const sim::line::FaultRules rules{.profile = *wire::find_profile("A351")};
    take_or_refuse(
        [&] { (void)sim::line::parse_fault_script(text, "faults.toml", UtcTime(), rules); });
    return 0;
}
