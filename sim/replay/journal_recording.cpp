#include "sim/replay/journal_recording.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "protocol/core/input_error.hpp"

namespace a351::sim::replay {
namespace {

using journal::Header;

constexpr std::size_t kIdentifierSize = 8;

std::string settings_text(int rate_hz, std::string_view filter, std::uint16_t burst_ctrl) {
    return fmt::format("{} Hz, {}, BURST_CTRL 0x{:04X}", rate_hz, filter, burst_ctrl);
}

/// Returns the text with the length of an identifier, which unreadable characters may have changed.
std::string identifier(std::string text) {
    text.resize(kIdentifierSize, ' ');
    return text;
}

journal::Header read_header(const std::filesystem::path& file) {
    journal::Reader reader(file);
    const auto chunk = reader.next();
    const auto* header = chunk ? std::get_if<journal::Header>(&*chunk) : nullptr;
    if (header == nullptr) {
        throw InputError(fmt::format("{}: {}; allowed: journal segments with a whole header",
                                     file.string(), reader.damage().front().reason));
    }
    return *header;
}

void require_known_settings(const std::filesystem::path& file, const journal::Header& header) {
    const auto* profile = wire::find_profile(header.profile);
    if (profile == nullptr) {
        throw InputError(fmt::format("{}: profile {}: unknown; allowed: {}", file.string(),
                                     header.profile, fmt::join(wire::profile_names(), ", ")));
    }
    const bool has_baud =
        std::ranges::count(profile->baud_rates, header.baud, &wire::Coded::value) > 0;
    if (!profile->has_output_rate(header.output_rate_hz) || !has_baud ||
        profile->filter_named(header.filter) == nullptr ||
        !wire::BurstLayout::from_burst_ctrl(header.burst_ctrl) ||
        !device::has_factory_codes(*profile)) {
        throw InputError(fmt::format(
            "{}: {}, {} baud: settings that profile {} does not have; allowed: those of its data "
            "sheet",
            file.string(), settings_text(header.output_rate_hz, header.filter, header.burst_ctrl),
            header.baud, header.profile));
    }
}

/// Returns true if both were recorded in the same boot.  Raw time restarts with each boot and only
/// rises within it.
bool is_same_boot(const journal::Header& before, const journal::Header& after) {
    return before.boot_id == after.boot_id && before.clock.raw <= after.clock.raw;
}

}  // namespace

JournalRecording::JournalRecording(std::vector<std::filesystem::path> segments,
                                   std::vector<RecordingDamage> damage)
    : damage_(std::move(damage)) {
    for (auto& file : segments) {
        Segment segment{std::move(file), {}, {}};
        segment.header = read_header(segment.file);
        require_known_settings(segment.file, segment.header);
        const timing::ClockReading& clock = segment.header.clock;
        segment.utc_minus_raw = clock.realtime.time_since_epoch() - clock.raw.time_since_epoch();
        if (!segments_.empty() && is_same_boot(segments_.back().header, segment.header))
            segment.utc_minus_raw = segments_.back().utc_minus_raw;
        segments_.push_back(std::move(segment));
    }
    open(0);
    load_piece();
    if (!has_piece_ && !begin_next_session()) {
        throw InputError(segments_.front().file.string() +
                         ": no byte was received; allowed: journal segments with received bytes");
    }
}

void JournalRecording::open(std::size_t segment) {
    at_ = segment;
    reader_.emplace(segments_[at_].file);
    chunk_ = {};
    read_ = 0;
    unit_ = {wire::find_profile(header().profile), {}, header().baud};
    unit_.identity.product_id = identifier(header().product_id);
    unit_.identity.serial_number = identifier(header().serial_number);
    unit_.identity.firmware = header().firmware;
}

/// Returns true if the next segment repeats what the newest damage of this one may have cost.
bool JournalRecording::is_repeated_later() const {
    return !reader_->damage().empty() && at_ + 1 < segments_.size() &&
           journal::is_repeated_later(reader_->damage().back(), header(),
                                      segments_[at_ + 1].header);
}

/// Loads the session's next chunk with received bytes; returns false if there is none.
bool JournalRecording::load_chunk() {
    while (true) {
        while (auto chunk = reader_->next()) {
            if (is_repeated_later()) break;
            const std::uint64_t number = journal::segment_number(segments_[at_].file).value_or(0);
            if (repetitions_.is_repeated(number, reader_->sequence(), *chunk)) continue;
            auto* received = std::get_if<journal::RxChunk>(&*chunk);
            if (received == nullptr || received->bytes.empty()) continue;
            chunk_ = std::move(*received);
            read_ = 0;
            return true;
        }
        for (const journal::Damage& damage : reader_->damage()) damage_.push_back(damage);
        if (at_ + 1 == segments_.size()) return false;
        const journal::Header& next = segments_[at_ + 1].header;
        if (next.session != header().session || !is_same_boot(header(), next)) return false;
        open(at_ + 1);
    }
}

void JournalRecording::load_piece() {
    has_piece_ = read_ < chunk_.reads.size() || load_chunk();
    if (!has_piece_) return;
    const UtcTime recorded(chunk_.reads[read_].time.time_since_epoch() +
                           segments_[at_].utc_minus_raw);
    due_ = std::max(due_, recorded);
}

std::optional<UtcTime> JournalRecording::next_due(const device::RegisterMachine&) const {
    return has_piece_ ? std::optional(due_) : std::nullopt;
}

void JournalRecording::send_next(device::RegisterMachine&, UtcTime leaves, device::LineSink& line) {
    const std::size_t begin = read_ == 0 ? 0 : chunk_.reads[read_ - 1].end;
    line.send(std::span(chunk_.bytes).subspan(begin, chunk_.reads[read_].end - begin), leaves,
              nullptr);
    ++read_;
    load_piece();
}

bool JournalRecording::begin_next_session() {
    while (!has_piece_ && at_ + 1 < segments_.size()) {
        open(at_ + 1);
        load_piece();
    }
    return has_piece_;
}

std::string JournalRecording::objection(const device::RegisterMachine& machine) const {
    const auto burst_ctrl = static_cast<std::uint16_t>(machine.value_of(wire::kBurstCtrl) &
                                                       wire::kBurstCtrl.defined_bits);
    const auto* filter = unit_.profile->filter_coded(
        static_cast<std::uint8_t>(machine.value_of(wire::kFilterCtrl) & wire::kFilterSelect));
    const bool is_auto = (machine.value_of(wire::kUartCtrl) & wire::kUartAuto) != 0;
    const bool is_triggered = (machine.value_of(wire::kMscCtrl) & wire::kMscExternalTrigger) != 0;
    if (machine.output_rate_hz() == header().output_rate_hz && filter->name == header().filter &&
        burst_ctrl == header().burst_ctrl && is_auto && !is_triggered) {
        return {};
    }
    return fmt::format(
        "the host asks for {}{}{}; {} was recorded with {}",
        settings_text(machine.output_rate_hz(), filter->name, burst_ctrl),
        is_auto ? "" : ", manual", is_triggered ? ", external trigger" : "",
        segments_[at_].file.string(),
        settings_text(header().output_rate_hz, header().filter, header().burst_ctrl));
}

}  // namespace a351::sim::replay
