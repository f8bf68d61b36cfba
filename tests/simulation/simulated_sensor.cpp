#include "tests/simulation/simulated_sensor.hpp"

#include <algorithm>
#include <utility>

namespace a351::simulation {

using daemon::source::PortError;

sim::signal::TimedSample NumberedSamples::next() {
    const std::int64_t number = next_++;
    return {instant(number), number, {axes(number), temperature(number)}};
}

void NumberedSamples::skip_to(UtcTime time) {
    const auto period = std::chrono::milliseconds(1000 / kRate_hz);
    next_ = std::max<std::int64_t>(next_, (time - start_) / period + 1);
}

std::array<std::int32_t, 3> NumberedSamples::axes(std::int64_t number) {
    // Knuth's multiplier: a permutation that looks random.
    const std::uint32_t noise = static_cast<std::uint32_t>(number) * 2'654'435'761U >> 28U;
    const auto n = static_cast<std::int32_t>(number);  // 16 n is below 15 g for the first 87 hours.
    return {16 * n + static_cast<std::int32_t>(noise), n,
            16 * n + 15 - static_cast<std::int32_t>(noise)};
}

std::optional<std::int64_t> NumberedSamples::number(std::size_t axis, std::int32_t counts) {
    const std::int64_t number = axis == 1 ? counts : counts / 16;
    if (axes(number).at(axis) != counts) return std::nullopt;
    return number;
}

std::int32_t NumberedSamples::temperature(std::int64_t number) {
    return 1000 + static_cast<std::int32_t>(number % 7);
}

/// The host's end of the line while the plug is in.
class SimulatedSensor::PluggedPort final : public daemon::source::Port {
public:
    PluggedPort(SimulatedSensor& sensor, int baud)
        : sensor_(sensor), baud_(baud), plugged_in_(sensor.plugged_in_) {
        sensor_.line_.set_speeds(sensor_.device_.baud(), baud_);
    }

    std::optional<std::size_t> read(std::span<std::byte> into,
                                    std::chrono::milliseconds timeout) override {
        const Nanoseconds end = sensor_.schedule_.now() + timeout;
        while (true) {
            if (!is_there()) return std::nullopt;
            sensor_.line_.set_speeds(sensor_.device_.baud(), baud_);
            const auto bytes = sensor_.line_.shown(sensor_.host_.true_time());
            const std::size_t count = std::min(bytes.size(), into.size());
            if (count > 0) {
                std::copy_n(bytes.begin(), count, into.begin());
                sensor_.line_.handed_over(count, sensor_.host_.true_time());
                sensor_.schedule_.yield();
                return count;
            }
            if (sensor_.schedule_.now() >= end) return 0;
            sensor_.schedule_.sleep_until(std::min(end, sensor_.next_event()));
        }
    }

    bool write(std::span<const std::byte> bytes) override {
        sensor_.schedule_.yield();
        if (!is_there()) return false;
        const int device_baud = sensor_.device_.baud();
        const auto heard = sim::line::received_at_baud(bytes, baud_, device_baud);
        sensor_.device_.receive(heard, sensor_.instant(), sensor_.injector_);
        sensor_.line_.set_speeds(sensor_.device_.baud(), baud_);
        return true;
    }

    const std::string& description() const noexcept override { return description_; }

private:
    bool is_there() {
        sensor_.serve();
        return sensor_.is_plugged_in() && plugged_in_ == sensor_.plugged_in_;
    }

    SimulatedSensor& sensor_;
    int baud_;
    int plugged_in_;
    std::string description_ = "simulated port";
};

SimulatedSensor::SimulatedSensor(std::uint64_t seed, Schedule& schedule, Host& host,
                                 const sim::scenario::LineParameters& line)
    : schedule_(schedule),
      host_(host),
      profile_(*wire::find_profile("A351")),
      samples_(host.true_time()),
      machine_(profile_, {.product_id = profile_.product_id}, Nanoseconds(0)),
      device_(samples_, machine_),
      line_(line, seed, host.true_time(), [this](const auto& record) { settle(record); }),
      injector_({.planned = {}, .random = {}, .seed = seed}, host.true_time(), line_, machine_,
                profile_, {.product_id = profile_.product_id},
                [](std::string_view, int) { return false; }) {}

sim::device::Instant SimulatedSensor::instant() const {
    const UtcTime now = host_.true_time();
    return {now, now - samples_.instant(0)};
}

void SimulatedSensor::settle(const sim::truth::Record& record) {
    const auto number = static_cast<std::size_t>(record.grid_index);
    if (number >= fates_.size()) fates_.resize(number + 1, Fate::not_sent);
    Fate fate = Fate::doubtful;
    switch (record.fate) {
        case sim::truth::Fate::intact:
            fate = Fate::arrived;
            break;
        case sim::truth::Fate::damaged:
            fate = Fate::damaged;
            break;
        case sim::truth::Fate::lost:
            fate = Fate::lost;
            break;
        case sim::truth::Fate::repeated:
        case sim::truth::Fate::misplaced:
            break;
    }
    fates_[number] = std::max(fates_[number], fate);
    if (fate == Fate::arrived) last_arrival_ = {static_cast<std::int64_t>(number), schedule_.now()};
}

void SimulatedSensor::apply(const sim::line::Fault& fault) {
    serve();
    injector_.begin(instant());
    injector_.apply(fault, host_.true_time());
    serve();
}

/// Lets the device send what is due, and moves the plug.
void SimulatedSensor::serve() {
    const auto now = instant();
    injector_.begin(now);
    do {
        device_.advance_to({now.simulated + line_.lead(), now.steady}, injector_);
        if (line_.is_full()) break;
    } while (*device_.next_due() <= now.simulated);
    injector_.catch_up(now);
    if (const auto asked = injector_.take_hang_up()) {
        if (!hang_up_) hang_up_ = asked;
        hang_up_->until = std::max(hang_up_->until, asked->until);
    }
    if (!hang_up_ || now.simulated < hang_up_->until) return;
    injector_.end_hang_up(*hang_up_, now);
    hang_up_.reset();
    ++plugged_in_;
}

/// Loses all that the host could read.
void SimulatedSensor::discard() {
    const UtcTime now = host_.true_time();
    line_.overrun(line_.shown(now).size(), now);
}

void SimulatedSensor::pass_unheard() {
    do {
        serve();
        discard();
    } while (*device_.next_due() <= host_.true_time() && !line_.is_full());
}

void SimulatedSensor::pass_without_power() {
    samples_.skip_to(host_.true_time());
    machine_.power_cycle(instant().steady);
    pass_unheard();
}

Nanoseconds SimulatedSensor::next_event() const {
    UtcTime next = *device_.next_due() - line_.lead();
    if (const auto shown = line_.next_shown()) next = std::min(next, *shown);
    if (hang_up_) next = std::min(next, hang_up_->until);
    const Nanoseconds wait = next - host_.true_time();
    return schedule_.now() +
           std::clamp<Nanoseconds>(wait, Nanoseconds(1000), std::chrono::milliseconds(20));
}

std::unique_ptr<daemon::source::Port> SimulatedSensor::open(int baud) {
    schedule_.yield();
    pass_unheard();
    if (!is_plugged_in())
        throw PortError(PortError::Kind::absent, "/dev/simulated", "there is no such port");
    return std::make_unique<PluggedPort>(*this, baud);
}

}  // namespace a351::simulation
