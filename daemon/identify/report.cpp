#include "daemon/identify/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "daemon/believable/limits.hpp"
#include "daemon/identify/received.hpp"
#include "daemon/identify/temperature.hpp"
#include "protocol/text/echo.hpp"

namespace a351::daemon::identify {
namespace {

// Standard deviation of an axis at rest, as a part of the norm.  A walk beside the box is a tenth.
constexpr double kRestTolerance = 0.005;
// Largest angle between the vertical and an axis that is called vertical.
constexpr double kMostTilt_deg = 30.0;

bool is_near(double value, double expected, double tolerance) {
    return std::abs(value / expected - 1.0) <= tolerance;
}

/// Collects the lines, and the values that a fitting profile must have.
class Judge {
public:
    Judge(const Observation& seen, const Expected& expected)
        : seen_(seen),
          expected_(expected),
          profile_(*expected.profile),
          received_(received(seen, expected.settings.layout)) {}

    Report judge() {
        const wire::DeviceIdentity& device = seen_.device;
        report_.sensor = fmt::format(
            "sensor {}, serial number {}, firmware {}, at {}", text::echoed(device.product_id),
            text::echoed(device.serial_number), device.firmware, seen_.port);
        judge_identity();
        judge_registers();
        judge_frames();
        judge_axes();
        judge_temperature();
        add_sources();
        fit();
        return std::move(report_);
    }

private:
    void add(Verdict verdict, std::string topic, std::string finding) {
        report_.lines.push_back({verdict, std::move(topic), std::move(finding)});
    }
    void compare(bool agrees, std::string topic, std::string finding) {
        add(agrees ? Verdict::confirmed : Verdict::differs, std::move(topic), std::move(finding));
    }

    /// Adds a line after which no profile can be said to fit.
    void leave_open(std::string topic, Verdict verdict, std::string finding) {
        is_fit_open_ = true;
        add(verdict, std::move(topic), std::move(finding));
    }

    void judge_identity() {
        const wire::DeviceIdentity& device = seen_.device;
        if (seen_.start_up_test == wire::StartUpTest::unknown)
            add(Verdict::unseen, "start-up test", "its result was not received");
        else
            compare(seen_.start_up_test == wire::StartUpTest::passed, "start-up test",
                    std::string(wire::to_text(seen_.start_up_test)));
        if (device.product_id.empty())
            return add(Verdict::unseen, "product and serial number", "not read");
        compare(device.product_id.starts_with(profile_.product_id_prefix), "product",
                fmt::format("{}; profile {} is for products that begin with {}",
                            text::echoed(device.product_id), profile_.name,
                            profile_.product_id_prefix));
        const std::string serial_number = text::echoed(device.serial_number);
        if (expected_.serial_number.empty())
            add(Verdict::unseen, "serial number",
                serial_number + "; the configuration names none (sensor.serial_number)");
        else
            compare(device.serial_number == expected_.serial_number, "serial number",
                    serial_number + ", expected " + expected_.serial_number);
    }

    /// Returns the end of the line about registers; empty if each answer came in time.
    [[nodiscard]] std::string asked_again() const {
        if (seen_.repeated_reads == 0) return "";
        return fmt::format("; reads repeated because an answer was late, lost or wrong: {}",
                           seen_.repeated_reads);
    }

    void judge_registers() {
        std::string silent;
        for (const auto& [reg, value] : seen_.registers)
            if (!value) silent += fmt::format("{}{}", silent.empty() ? "" : ", ", reg->name);
        if (seen_.registers.empty())
            add(Verdict::unseen, "registers", "not read");
        else
            compare(silent.empty(), "registers",
                    (silent.empty() ? fmt::format("{} answered", seen_.registers.size())
                                    : "no answer from " + silent) +
                        asked_again());
        compare(seen_.trouble.empty(), "settings",
                seen_.trouble.empty() ? "the sensor took all of them" : seen_.trouble);
        compare(seen_.baud == expected_.baud, "baud rate",
                fmt::format("{}, expected {}", seen_.baud, expected_.baud));
    }

    void judge_frames() {
        const std::size_t size = expected_.settings.layout.frame_size();
        // The first bytes may be the rest of a frame, and the last ones its begin.
        const bool is_understood = !received_.frames.empty() && received_.skipped < size;
        if (seen_.bytes.empty()) {
            return add(seen_.trouble.empty() ? Verdict::differs : Verdict::unseen, "frames",
                       "no byte arrived");
        }
        compare(is_understood, "frames",
                fmt::format("{} of {} bytes each; {} bytes are not understood",
                            received_.frames.size(), size, received_.skipped));
        if (received_.rate_hz <= 0.0) return add(Verdict::unseen, "rate", "too few frames");
        const int rate_hz = expected_.settings.output_rate_hz;
        compare(is_near(received_.rate_hz, rate_hz, kMostRateError), "rate",
                fmt::format("{:.3f} frames a second, expected {} within 0.5 %", received_.rate_hz,
                            rate_hz));
        const double tick_hz = received_.rate_hz * received_.count_step;
        compare(is_near(tick_hz, profile_.internal_rate_hz, kMostRateError), "tick",
                fmt::format("COUNT rises by {} a frame, {:.1f} a second, expected {} within 0.5 %",
                            received_.count_step, tick_hz, profile_.internal_rate_hz));
    }

    void judge_axes() {
        if (received_.frames.empty())
            return add(Verdict::unseen, "norm, vertical axis, noise", "no frames");
        const double unit_g = std::ldexp(1.0, -profile_.acceleration_fraction_bits);
        std::array<double, 3> mean_g{};
        double square = 0.0, scatter = 0.0;
        for (std::size_t i = 0; i < mean_g.size(); ++i) {
            mean_g[i] = unit_g * received_.axes[i].mean_counts;
            square += mean_g[i] * mean_g[i];
            scatter = std::max(scatter, unit_g * received_.axes[i].deviation_counts);
        }
        const double norm_g = std::sqrt(square);
        if (scatter > kRestTolerance * norm_g)
            leave_open("norm", Verdict::unseen, "the box moved; leave it at rest and repeat");
        else
            judge_norm(norm_g);
        judge_vertical(mean_g, norm_g);
        for (std::size_t i = 0; i < mean_g.size(); ++i) {
            const Received::Axis& axis = received_.axes[i];
            compare(!axis.is_constant, fmt::format("noise of {}", "xyz"[i]),
                    axis.is_constant
                        ? "all samples are equal: this axis is dead"
                        : fmt::format("{:.1f} ug a sample", 1e6 * unit_g * axis.noise_counts));
        }
    }

    void judge_norm(double norm_g) {
        const std::string found = fmt::format(
            "{:.5f} g, {:+.2f} mg from normal gravity at the position; at rest {:.1f} to {:.1f} g",
            norm_g, 1e3 * (norm_g - expected_.gravity.value()), kLeastNorm.value(),
            kMostNorm.value());
        changes_.acceleration_fraction_bits = profile_.acceleration_fraction_bits;
        const auto is_scale = [&](int excess) {
            return is_norm_believable(StandardGravity(std::ldexp(norm_g, -excess)));
        };
        if (is_scale(0)) return add(Verdict::confirmed, "norm", found);
        const int excess = norm_g > 0.0 ? static_cast<int>(std::lround(std::log2(norm_g))) : 0;
        if (!is_scale(excess))
            return leave_open("norm", Verdict::differs, found + "; no scale of the family fits");
        *changes_.acceleration_fraction_bits += excess;
        add(Verdict::differs, "norm",
            fmt::format("{}; acceleration.fraction_bits = {} fits", found,
                        *changes_.acceleration_fraction_bits));
    }

    void judge_vertical(const std::array<double, 3>& mean_g, double norm_g) {
        const auto longest =
            std::ranges::max_element(mean_g, {}, [](double g) { return std::abs(g); });
        const auto axis = static_cast<std::size_t>(longest - mean_g.begin());
        const double tilt_deg = std::acos(std::min(1.0, std::abs(*longest) / norm_g)) * kDegPerRad;
        if (norm_g <= 0.0 || !(tilt_deg <= kMostTilt_deg))
            return add(Verdict::unseen, "vertical axis", "no axis is within 30 degrees");
        const auto called = std::ranges::find(expected_.axes, "Z");
        const std::string found = fmt::format("{}{}, {:.1f} degrees from the vertical",
                                              *longest < 0.0 ? "-" : "", "xyz"[axis], tilt_deg);
        if (called == expected_.axes.end())
            return add(Verdict::unseen, "vertical axis", found + "; sensor.axes has no Z");
        const auto expected = static_cast<std::size_t>(called - expected_.axes.begin());
        compare(axis == expected, "vertical axis",
                fmt::format("{}; sensor.axes calls {} Z", found, "xyz"[expected]));
    }

    void judge_temperature() {
        if (received_.frames.empty() || !expected_.settings.layout.has_temperature())
            return add(Verdict::unseen, "temperature", "no frames with it");
        const TemperatureFinding finding = temperature_of(received_.frames, profile_);
        if (!finding.fits) return leave_open("temperature", finding.verdict, finding.text);
        add(finding.verdict, "temperature", finding.text);
        changes_.temperature = finding.fits;
    }

    void add_sources() {
        report_.sources = fmt::format(
            "the values of profile {}, {}, are from\n", profile_.name,
            profile_.is_verified ? "which says that it is verified" : "which is not verified");
        for (const std::string& source : sources_of(profile_))
            report_.sources += "  " + source + "\n";
    }

    /// Chooses the profile that fits.
    void fit() {
        const std::string& product = seen_.device.product_id;
        if (product.empty() || received_.frames.empty() || is_fit_open_) return;
        const wire::DeviceProfile* base = &profile_;
        if (!product.starts_with(profile_.product_id_prefix)) {
            const auto* const shipped = shipped_profile_of(product);
            if (shipped != nullptr)
                base = shipped;
            else
                changes_.product_id = product;
        }
        if (changes_.acceleration_fraction_bits == base->acceleration_fraction_bits)
            changes_.acceleration_fraction_bits.reset();
        const auto& temperature = changes_.temperature;
        if (temperature && temperature->slope_degc == base->temperature_slope_degc &&
            temperature->offset_degc == base->temperature_offset_degc)
            changes_.temperature.reset();
        if (changes_.is_empty())
            report_.profile = base->name;
        else
            report_.toml = fitting_profile(*base, changes_);
    }

    const Observation& seen_;
    const Expected& expected_;
    const wire::DeviceProfile& profile_;
    Received received_;
    Changes changes_;
    bool is_fit_open_ = false;
    Report report_;
};

}  // namespace

const char* to_text(Verdict verdict) noexcept {
    if (verdict == Verdict::confirmed) return "confirmed";
    return verdict == Verdict::differs ? "differs" : "cannot be seen";
}

bool Report::differs() const {
    return std::ranges::any_of(lines,
                               [](const Line& line) { return line.verdict == Verdict::differs; });
}

Report report_on(const Observation& seen, const Expected& expected) {
    return Judge(seen, expected).judge();
}

std::string to_text(const Report& report) {
    std::string text = report.sensor + "\n";
    for (const Line& line : report.lines)
        text += fmt::format("{:<14} {}: {}\n", to_text(line.verdict), line.topic, line.finding);
    return text + report.sources;
}

std::string advice(const Report& report, const std::string& profile, const std::string& stem) {
    std::string text;
    if (report.toml)
        text = fmt::format("set sensor.profile = \"{0}.toml\": this new file fits\n", stem);
    else if (report.profile.empty())
        text = "no profile is known that fits\n";
    else if (report.profile == profile)
        text = fmt::format("profile {} fits\n", profile);
    else
        text = fmt::format("set sensor.profile = \"{}\": this profile fits\n", report.profile);
    return text +
           fmt::format(
               "please send {}.txt to the maintainers of a351: it has the registers and 50 s "
               "of data, by which the profile can be verified\n",
               stem);
}

std::string explain_silence(const Observation& seen) {
    if (is_text(seen.heard)) {
        const std::string line = seen.heard.substr(0, seen.heard.find_first_of("\r\n", 1));
        return fmt::format(
            "{}: text arrives (\"{}\"): this is another instrument, for example a GPS receiver; "
            "find the sensor's port with a351d --list-ports",
            seen.port, text::echoed(line));
    }
    if (!seen.heard.empty()) {
        return fmt::format(
            "{}: bytes arrive, but none can be understood at any baud rate; if this is the "
            "sensor's port (a351d --list-ports), check its adapter",
            seen.port);
    }
    return seen.port + ": no answer at any baud rate; check the sensor's plug and its power";
}

}  // namespace a351::daemon::identify
