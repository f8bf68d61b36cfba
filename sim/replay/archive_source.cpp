#include "sim/replay/archive_source.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "protocol/archive/miniseed.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/files/file_bytes.hpp"

namespace a351::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTemperatureField = 3;

/// Returns the header of the first record of a file.
record::RecordHeader first_header(const fs::path& file) {
    std::array<std::byte, record::kRecordSize> bytes{};
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    auto decoded = in ? record::decode_record(bytes) : std::nullopt;
    if (!decoded) {
        throw InputError(file.string() +
                         ": begins with no record of an archive; allowed: journal segments, or "
                         "miniSEED files of a data root");
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
        throw InputError(file.string() + ": channel " + channel + ": not of the axes " + axes[0] +
                         "," + axes[1] + "," + axes[2] + "; allowed: --axes with its last letter");
    }
    return static_cast<std::size_t>(axis - axes.begin());
}

std::string at_rate(const std::string& station, int rate_hz) {
    return station + " at " + std::to_string(rate_hz) + " Hz";
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
    /// Loads the next good record; none after the last.  Stray bytes may have shifted the records
    /// after them, so every offset is tried.
    void load() {
        sample_ = 0;
        std::uint64_t bytes_skipped = 0;
        while (true) {
            while (offset_ < bytes_.size()) {
                const auto rest = std::span<const std::byte>(bytes_).subspan(offset_);
                auto record =
                    record::decode_record(rest.first(std::min(rest.size(), record::kRecordSize)));
                if (record && record->header.channel == name_) {
                    report(bytes_skipped);
                    offset_ += record::kRecordSize;
                    record_ = std::move(*record);
                    return;
                }
                ++offset_;
                ++bytes_skipped;
            }
            report(bytes_skipped);
            bytes_skipped = 0;
            if (file_ == files_.size()) break;
            path_ = files_[file_++].path;
            bytes_ = record::read_bytes(path_);
            offset_ = 0;
        }
        record_.samples.clear();
    }

    void report(std::uint64_t byte_count) {
        if (byte_count == 0) return;
        damage_.push_back({path_, offset_ - byte_count, byte_count, "no record of " + name_});
    }

    std::string name_;
    std::vector<RecordingDamage>& damage_;
    std::vector<File> files_;
    std::size_t file_ = 0;  ///< Index of the next file.
    fs::path path_;
    std::vector<std::byte> bytes_;
    std::size_t offset_ = 0;
    record::DecodedRecord record_;
    std::size_t sample_ = 0;
};

ArchiveSource::ArchiveSource(const std::vector<fs::path>& files,
                             const std::array<std::string, 3>& axes) {
    std::string station;
    for (const fs::path& file : files) {
        const record::RecordHeader header = first_header(file);
        const auto field = field_of(file, header.channel, axes);
        if (!field) continue;
        const std::string codes = header.network + "." + header.station + "." + header.location;
        const int rate_hz = static_cast<int>(std::lround(header.nominal_rate.value()));
        if (station.empty()) {
            station = codes;
            rate_hz_ = rate_hz;
        }
        if (codes != station || rate_hz != rate_hz_) {
            throw InputError(file.string() + ": " + at_rate(codes, rate_hz) + " beside " +
                             at_rate(station, rate_hz_) + "; allowed: one station at one rate");
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

TimedSample ArchiveSource::next() {
    const TimedSample sample = *next_;
    advance();
    return sample;
}

void ArchiveSource::advance() {
    const double period_s = 1.0 / rate_hz_;
    const TimedSample before = *next_;
    begins_run_ = false;
    while (true) {
        std::optional<UtcTime> earliest;
        for (const auto& channel : channels_) {
            if (!channel || channel->is_over()) continue;
            if (!earliest || channel->time() < *earliest) earliest = channel->time();
        }
        next_.reset();
        if (!earliest) return;

        TimedSample sample;
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

}  // namespace a351::sim
