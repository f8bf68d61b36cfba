#include "corrector/archive_series/wrong_profile.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/sensor_limits.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/signal/median.hpp"

namespace a351::corrector::archive_series {
namespace {

constexpr std::chrono::seconds kPiece(10);
// Largest relative error of the rate while a minute is not complete: a host may pause for a second.
constexpr std::size_t kPiecesOfMinute = 6;
constexpr double kMostRateErrorOfFew = 0.1;
// Least share of the samples that follow the one before.  With a wrong rate none does; a line that
// loses samples at random has as many as it does not lose.
constexpr double kLeastFollowing = 0.25;

/// Values that the pieces of a journal have with a profile.
class Pieces final : public archive::Sink {
public:
    explicit Pieces(const wire::DeviceProfile& profile) : profile_(profile) {}

    void record(const std::string&, const archive::PackedRecord&, std::int64_t) override {}
    void sample(const archive::Sample& sample) override {
        for (std::size_t k = 0; k < sum_g_.size(); ++k)
            sum_g_[k] += profile_.acceleration(sample.values.axes[k]).value();
        sum_degc_ += profile_.temperature(sample.values.temperature).value();
        ++samples_;
        if (previous_ && sample.index == *previous_ + 1) ++following_;
        previous_ = sample.index;
    }

    /// Begins a piece at the next arrival of samples.
    void begin(const journal::Header& header) {
        nominal_hz_ = header.output_rate_hz;
        start_.reset();
    }

    /// Ends the piece if it is long enough.
    /// @param index  of the newest sample, which has arrived at this time.
    void arrived(std::int64_t index, RawTime time) {
        if (start_ && index >= start_->index && time - start_->time < kPiece) return;
        if (start_ && index > start_->index && samples_ > 0) {
            const double seconds = std::chrono::duration<double>(time - start_->time).count();
            const auto count = static_cast<double>(samples_);
            norms_g.push_back(std::hypot(sum_g_[0], sum_g_[1], sum_g_[2]) / count);
            temperatures_degc.push_back(sum_degc_ / count);
            rates.push_back(static_cast<double>(index - start_->index) / seconds / nominal_hz_);
            shares_following.push_back(static_cast<double>(following_) / count);
        }
        start_ = {index, time};
        sum_g_ = {};
        sum_degc_ = 0.0;
        samples_ = following_ = 0;
    }

    std::vector<double> norms_g, temperatures_degc;
    std::vector<double> rates;             ///< Rate of the indices, divided by the nominal one.
    std::vector<double> shares_following;  ///< Samples whose index is the next one, divided by all.

private:
    struct Arrival {
        std::int64_t index;
        RawTime time;
    };
    const wire::DeviceProfile& profile_;
    double nominal_hz_ = 0.0;
    std::optional<Arrival> start_;
    std::array<double, 3> sum_g_{};
    double sum_degc_ = 0.0;
    std::int64_t samples_ = 0, following_ = 0;
    std::optional<std::int64_t> previous_;  ///< Index of the newest sample.
};

[[noreturn]] void refuse(const wire::DeviceProfile& profile, const std::string& values) {
    throw InputError(
        fmt::format("profile {}: with it {}: {}", profile.name, values, kWrongProfile));
}

}  // namespace

text::Message refuse_wrong_profile(const std::filesystem::path& root,
                                   const wire::DeviceProfile& profile) {
    Pieces pieces(profile);
    archive::Archiver archiver(pieces);
    journal::Sequence sequence(journal::segment_files(root / "journal"));
    text::Message other_product;
    bool has_temperature = true;
    while (auto chunk = sequence.next()) {
        if (auto* const header = std::get_if<journal::Header>(&*chunk)) {
            *header = archive::recorded_with(profile, std::move(*header));
            if (!header->product_id.starts_with(profile.product_id_prefix) &&
                !header->product_id.empty())
                other_product = text::message(
                    "the sensor reported the product {}, profile {} is for {}: check that it is "
                    "the right one",
                    header->product_id, profile.name, profile.product_id_prefix);
            const auto layout = wire::BurstLayout::from_burst_ctrl(header->burst_ctrl);
            has_temperature = has_temperature && layout && layout->has_temperature();
            pieces.begin(*header);
        }
        archiver.take(*chunk);
        if (const auto* const received = std::get_if<journal::RxChunk>(&*chunk);
            received != nullptr && archiver.last_index())
            pieces.arrived(*archiver.last_index(), received->reads.back().time);
    }
    if (pieces.rates.empty()) return other_product;
    const double rate = signal::median(pieces.rates);
    const bool is_short = pieces.rates.size() < kPiecesOfMinute;
    if (std::abs(rate - 1.0) > (is_short ? kMostRateErrorOfFew : kMostRateError))
        refuse(profile, fmt::format("{:.3g} times the samples of the output rate arrived", rate));
    const double following = signal::median(pieces.shares_following);
    if (following < kLeastFollowing)
        refuse(profile, fmt::format("{:.0f} % of the samples follow the one before, as if the "
                                    "others were lost",
                                    100.0 * following));
    const StandardGravity norm(signal::median(pieces.norms_g));
    if (!is_norm_believable(norm))
        refuse(profile, fmt::format("the acceleration reads {:.2f} g", norm.value()));
    const DegC temperature(signal::median(pieces.temperatures_degc));
    if (has_temperature && !is_temperature_believable(temperature))
        refuse(profile, fmt::format("the temperature reads {:.1f} degC", temperature.value()));
    return other_product;
}

}  // namespace a351::corrector::archive_series
