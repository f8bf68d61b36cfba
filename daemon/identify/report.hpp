#pragma once
/// @file
/// A sensor's answers and frames, compared with the configuration.  Pure: no port, no clock, no file.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "daemon/identify/fitting_profile.hpp"
#include "daemon/identify/observation.hpp"
#include "protocol/core/units.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::identify {

/// Values of the configuration.
struct Expected {
    const wire::DeviceProfile* profile = nullptr;  ///< Not null.
    wire::SensorSettings settings = {};            ///< With COUNT in the layout.
    int baud = 460800;
    std::string serial_number = {};        ///< Empty accepts any.
    std::array<std::string, 3> axes = {};  ///< Letters of x, y, z; Z is the vertical one.
    StandardGravity gravity{1.0};          ///< Normal gravity at the position.
};

enum class Verdict { confirmed, differs, unseen };

/// Returns "confirmed", "differs" or "cannot be seen".
[[nodiscard]] const char* to_text(Verdict verdict) noexcept;

/// One statement about the sensor.
struct Line {
    Verdict verdict = Verdict::unseen;
    std::string topic;    ///< Thing that was compared.
    std::string finding;  ///< Value found, and value expected.
};

struct Report {
    std::string sensor;  ///< Product, serial number, firmware and port, in one line.
    std::vector<Line> lines;
    std::string sources;  ///< Lines that say where each value of the configured profile is from.
    /// Shipped profile that fits; empty if none does, or if nothing is known.
    std::string profile;
    /// Text of a profile file that fits if no shipped profile does.
    std::optional<std::string> toml;

    [[nodiscard]] bool differs() const;
};

/// Compares what was seen with the configuration.
///
/// The box must be at rest.  Limits: rate and tick 0.5 %, a hundred times the error of a crystal; norm
/// and temperature as in daemon/believable.  Noise is shown, not judged.
/// @param seen  an observation with `has_answered`.
[[nodiscard]] Report report_on(const Observation& seen, const Expected& expected);

/// Returns the report as text: one line for each statement, then the sources.
[[nodiscard]] std::string to_text(const Report& report);

/// Returns what to do after a report: which profile to use, and which file to send.
/// @param profile  name of the configured profile.
/// @param stem     name of the files, without ending.
[[nodiscard]] std::string advice(const Report& report, const std::string& profile,
                                 const std::string& stem);

/// Returns why nothing could be compared, and what to do.
/// @param seen  an observation without `has_answered`.
[[nodiscard]] std::string explain_silence(const Observation& seen);

}  // namespace a351::daemon::identify
