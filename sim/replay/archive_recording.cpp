#include "sim/replay/archive_recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "protocol/archive/record_file.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::sim::replay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTemperatureField = 3;

/// Samples, more than any transient has: twice the longest long-term filter (M-A352AD10 data sheet,
/// 7.19) and the 127 samples of table 5.4.
constexpr int kMostSuppressed = 2 * 4096 + 127;

/// Returns the header of the first record of a file.
archive::RecordHeader first_header(const fs::path& file) {
    std::array<std::byte, archive::kRecordSize> bytes{};
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    auto decoded = in ? archive::decode_record(bytes) : std::nullopt;
    if (!decoded) {
        throw InputError(
            fmt::format("{}: begins with no record of an archive; allowed: journal segments, or "
                        "miniSEED files of a data root",
                        file.string()));
    }
    return std::move(decoded->header);
}

/// Returns the field of a channel: x, y, z, temperature; std::nullopt for other channels.
std::optional<std::size_t> field_of(const fs::path& file, const std::string& channel,
                                    const std::array<std::string, 3>& axes) {
    if (channel.ends_with("K1") && channel.front() != 'L') return kTemperatureField;
    if (channel.size() != 3 || channel[1] != 'N') return std::nullopt;
    const auto axis = std::ranges::find(axes, channel.substr(2));
    if (axis == axes.end()) {
        throw InputError(fmt::format(
            "{}: channel {}: not of the axes {},{},{}; allowed: --axes with its last letter",
            file.string(), channel, axes[0], axes[1], axes[2]));
    }
    return static_cast<std::size_t>(axis - axes.begin());
}

}  // namespace

/// The samples of one channel in the order of its records.
class ArchiveSource::Channel {
public:
    struct File {
        UtcTime start;
        fs::path path;
    };

    Channel(std::string name, std::vector<RecordingDamage>& damage)
        : name_(std::move(name)), damage_(damage) {}

    void add(File file) { files_.push_back(std::move(file)); }

    /// Starts reading; call it once all files have been added.
    void begin() {
        std::ranges::stable_sort(files_, {}, &File::start);
        load();
    }

    [[nodiscard]] bool is_over() const noexcept { return record_.samples.empty(); }
    [[nodiscard]] UtcTime time() const {
        return record_.header.start +
               from_seconds(static_cast<double>(sample_) / record_.rate_hz());
    }
    [[nodiscard]] bool begins_run() const { return sample_ == 0 && record_.header.starts_series; }
    [[nodiscard]] std::int32_t counts() const { return record_.samples[sample_]; }

    void pop() {
        if (++sample_ == record_.samples.size()) load();
    }

private:
    /// Loads the next good record; none after the last.
    void load() {
        sample_ = 0;
        record_.samples.clear();
        while (record_.samples.empty()) {
            if (!records_) {
                if (file_ == files_.size()) return;
                records_.emplace(files_[file_].path, name_);
            }
            auto found = records_->next();
            if (records_->skipped() > 0)
                damage_.push_back({files_[file_].path, records_->skipped_at(), records_->skipped(),
                                   "no record of " + name_});
            if (found) {
                record_ = std::move(found->record);
            } else {
                records_.reset();
                ++file_;
            }
        }
    }

    std::string name_;
    std::vector<RecordingDamage>& damage_;
    std::vector<File> files_;
    std::size_t file_ = 0;  ///< Index of the file that is read.
    std::optional<archive::RecordFile> records_;
    archive::DecodedRecord record_;
    std::size_t sample_ = 0;
};

ArchiveSource::ArchiveSource(const std::vector<fs::path>& files,
                             const std::array<std::string, 3>& axes) {
    std::string station;
    for (const fs::path& file : files) {
        const archive::RecordHeader header = first_header(file);
        const auto field = field_of(file, header.channel, axes);
        if (!field) continue;
        const std::string codes =
            fmt::format("{}.{}.{}", header.network, header.station, header.location);
        const int rate_hz = static_cast<int>(std::lround(header.nominal_rate.value()));
        if (station.empty()) {
            station = codes;
            rate_hz_ = rate_hz;
        }
        if (codes != station || rate_hz != rate_hz_) {
            throw InputError(
                fmt::format("{}: {} at {} Hz beside {} at {} Hz; allowed: one station at one rate",
                            file.string(), codes, rate_hz, station, rate_hz_));
        }
        auto& channel = channels_.at(*field);
        if (!channel) channel = std::make_unique<Channel>(header.channel, damage_);
        channel->add({header.start, file});
    }
    if (!channels_[0] && !channels_[1] && !channels_[2]) {
        throw InputError((files.empty() ? std::string() : files.front().string() + ": ") +
                         "no axis among the files; allowed: channels such as BN1, BN2, BNZ, BK1");
    }
    for (auto& channel : channels_) {
        if (channel) channel->begin();
    }
    next_.emplace();
    next_->index = -1;
    advance();
}

ArchiveSource::~ArchiveSource() = default;

std::optional<UtcTime> ArchiveSource::next_instant() const {
    return next_ ? std::optional(next_->instant) : std::nullopt;
}

signal::TimedSample ArchiveSource::next() {
    const signal::TimedSample sample = *next_;
    advance();
    return sample;
}

void ArchiveSource::advance() {
    const double period_s = 1.0 / rate_hz_;
    const signal::TimedSample before = *next_;
    begins_run_ = false;
    while (true) {
        std::optional<UtcTime> earliest;
        for (const auto& channel : channels_) {
            if (!channel || channel->is_over()) continue;
            if (!earliest || channel->time() < *earliest) earliest = channel->time();
        }
        next_.reset();
        if (!earliest) return;

        signal::TimedSample sample;
        sample.instant = *earliest;
        bool is_whole = true;
        for (std::size_t field = 0; field < channels_.size(); ++field) {
            Channel* const channel = channels_[field].get();
            if (channel == nullptr) continue;
            if (channel->is_over() || channel->time() - *earliest > from_seconds(0.5 * period_s)) {
                is_whole = false;
                continue;
            }
            (field == kTemperatureField ? sample.values.temperature_counts
                                        : sample.values.axes_counts[field]) = channel->counts();
            begins_run_ = begins_run_ || channel->begins_run();
            channel->pop();
        }
        if (!is_whole) {
            ++incomplete_;
            continue;
        }
        if (before.index >= 0) {
            const double passed = seconds_between(before.instant, sample.instant) / period_s;
            sample.index = before.index + std::max<std::int64_t>(1, std::llround(passed));
        }
        next_ = sample;
        return;
    }
}

ArchiveRecording::ArchiveRecording(std::unique_ptr<ArchiveSource> source, RecordedUnit unit)
    : source_(std::move(source)), unit_(std::move(unit)) {}

std::optional<UtcTime> ArchiveRecording::next_due(const device::RegisterMachine& machine) const {
    const auto instant = source_->next_instant();
    if (!instant || is_session_over_) return std::nullopt;
    return *instant + machine.frame_delay();
}

void ArchiveRecording::send_next(device::RegisterMachine& machine, UtcTime leaves,
                                 device::LineSink& line) {
    const signal::TimedSample sample = source_->next();
    bytes_.clear();
    std::optional<wire::BurstValues> values;
    if (machine.sampling_run() == run_) {
        for (; next_index_ < sample.index; ++next_index_) machine.skip_sample();
        values = machine.sample(sample.values, bytes_);
    } else {
        run_ = machine.sampling_run();
        for (int i = 0; i <= kMostSuppressed && !values; ++i)
            values = machine.sample(sample.values, bytes_);
    }
    next_index_ = sample.index + 1;
    is_session_over_ = source_->begins_run();
    if (!values) return;
    const truth::Record truth{sample.instant, *values, static_cast<std::uint16_t>(run_),
                              static_cast<std::uint32_t>(sample.index)};
    line.send(bytes_, leaves, &truth);
}

bool ArchiveRecording::begin_next_session() {
    is_session_over_ = false;
    return source_->next_instant().has_value();
}

std::string ArchiveRecording::objection(const device::RegisterMachine& machine) const {
    if (machine.output_rate_hz() != source_->rate_hz()) {
        return fmt::format("the host asks for {} Hz; the archive has {} Hz",
                           machine.output_rate_hz(), source_->rate_hz());
    }
    if ((machine.value_of(wire::kUartCtrl) & wire::kUartAuto) == 0 ||
        (machine.value_of(wire::kMscCtrl) & wire::kMscExternalTrigger) != 0) {
        return "the host asks for manual or triggered sampling; a replay sends by itself";
    }
    const auto layout = wire::BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(
        machine.value_of(wire::kBurstCtrl) & wire::kBurstCtrl.defined_bits));
    if (!layout) return "the host asks for frames without an axis";
    for (std::size_t field = 0; field < ArchiveSource::kFields.size(); ++field) {
        const bool is_asked = field == 3 ? layout->has_temperature()
                                         : layout->has_axis(static_cast<wire::Axis>(field));
        if (is_asked && !source_->has_field(field)) {
            return fmt::format("the host asks for {}, which the archive lacks",
                               ArchiveSource::kFields[field]);
        }
    }
    return {};
}

}  // namespace a351::sim::replay
