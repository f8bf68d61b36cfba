#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "protocol/signal/moved_box.hpp"

namespace a351::signal {

inline constexpr double kStep_s = 2.0;
inline constexpr double kDeg_mgal = 980665.0 * 3.141592653589793 / 180.0;

/// A box on quiet ground: 10 mGal of noise on each decimated axis, a shake of 60 mGal.
class MadeUpBox {
public:
    explicit MadeUpBox(unsigned seed, double rest_s = 0.0) : random_(seed) { rest(rest_s); }

    /// Returns a box that is moved after moved_s(), and is then at rest.
    /// @param kind  0: carried to the car, driven, set down at another benchmark; 1: lifted by 10 cm and
    ///              set down; 2: kicked.
    static MadeUpBox that_moves(int kind, unsigned seed) {
        MadeUpBox box(1000 * static_cast<unsigned>(kind) + seed);
        box.shake(box.between(5.0, 25.0), 10000.0);
        box.rest(box.between(240.0, 700.0));
        box.moved_s_ = box.now_s();
        if (kind == 0) {
            box.shake(box.between(8.0, 25.0), 20000.0);
            box.rest(box.between(0.0, 300.0));
            box.shake(box.between(120.0, 900.0), 20000.0);
            box.place(box.between(-40.0, 40.0));
        } else if (kind == 1) {
            box.shake(box.between(8.0, 25.0), 20000.0);
            box.place(0.0);
        } else {
            box.shake(2.0, 15000.0);
            box.turn(0.05);
        }
        box.rest(box.between(60.0, 400.0));
        return box;
    }
    [[nodiscard]] double moved_s() const { return moved_s_; }

    /// Adds time at rest.
    void rest(double seconds) { add(seconds, 60.0, 10.0); }
    /// Adds shaking, as half peak to peak of the raw samples, and what the filter lets through.
    void shake(double seconds, double peak_mgal) { add(seconds, peak_mgal, 0.01 * peak_mgal); }
    /// Turns the box by this angle, in a random direction.
    void turn(double deg) {
        const double direction = 6.283 * std::uniform_real_distribution<double>()(random_);
        x_mgal_ += deg * kDeg_mgal * std::cos(direction);
        y_mgal_ += deg * kDeg_mgal * std::sin(direction);
    }
    /// Levels the box as an operator does, within 0.1 deg, at another gravity.
    void place(double gravity_mgal) {
        std::normal_distribution<double> tilt_mgal(0.0, 0.1 * kDeg_mgal);
        x_mgal_ = tilt_mgal(random_);
        y_mgal_ = tilt_mgal(random_);
        gravity_mgal_ += gravity_mgal;
    }
    double between(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }

    [[nodiscard]] const std::vector<MotionSample>& samples() const { return samples_; }
    /// Returns the time since the begin, s.
    [[nodiscard]] double now_s() const { return kStep_s * static_cast<double>(samples_.size()); }

private:
    void add(double seconds, double shake_mgal, double noise_mgal) {
        std::normal_distribution<double> normal;
        const auto count = static_cast<std::size_t>(seconds / kStep_s);
        for (std::size_t i = 0; i < count; ++i) {
            const double z_mgal =
                std::sqrt(gravity_mgal_ * gravity_mgal_ - x_mgal_ * x_mgal_ - y_mgal_ * y_mgal_);
            samples_.push_back({UtcTime{} + from_seconds(now_s()),
                                {MilliGal(x_mgal_ + noise_mgal * normal(random_)),
                                 MilliGal(y_mgal_ + noise_mgal * normal(random_)),
                                 MilliGal(z_mgal + 0.2 * noise_mgal * normal(random_))},
                                MilliGal(shake_mgal)});
        }
    }

    std::mt19937_64 random_;
    double x_mgal_ = 0.0, y_mgal_ = 0.0, gravity_mgal_ = 979900e0;
    std::vector<MotionSample> samples_;
    double moved_s_ = 0.0;
};

}  // namespace a351::signal
