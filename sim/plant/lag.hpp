#pragma once
/// @file
/// A first-order lag of a temperature.

namespace a351::sim::plant {

/// A temperature after a first-order lag, which starts in equilibrium:
///
///     tau dy/dt = T - y
///
/// It is exact for a temperature that changes in straight lines between steps.
class Lag {
public:
    /// @param tau_s   time constant, s; above 0.
    /// @param step_s  time between two calls of next(), s; above 0.
    /// @param degc    temperature before the first step, degC.
    Lag(double tau_s, double step_s, double degc);

    /// Advances one step, in which the temperature goes from one value to another; returns y, degC.
    [[nodiscard]] double next(double from_degc, double to_degc) noexcept;

    /// Returns y after the last step, degC.
    [[nodiscard]] double degc() const noexcept { return degc_; }

private:
    double keep_, of_rise_;
    double degc_;
};

}  // namespace a351::sim::plant
