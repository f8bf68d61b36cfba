#include "corrector/archive_series/samples.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

#include "corrector/archive_series/on_all_cores.hpp"
#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/journal_tail.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::archive_series {

namespace {

/// Returns the memory of the longest segment.
std::vector<std::int32_t> memory_of(archive::ChannelData& channel) {
    const auto longest = std::ranges::max_element(
        channel.segments, {},
        [](const archive::Segment& segment) { return segment.counts.capacity(); });
    return longest == channel.segments.end() ? std::vector<std::int32_t>()
                                             : std::move(longest->counts);
}

}  // namespace

std::vector<archive::ChannelData> read_samples(const std::filesystem::path& root,
                                               const Epoch& epoch, const Span& span,
                                               std::vector<archive::ChannelData> earlier) {
    earlier.resize(epoch.channels.size());
    on_all_cores(earlier.size(), [&](std::size_t k) {
        earlier[k] = archive::read_channel(root / "archive", epoch.codes, epoch.channels[k].code,
                                           span.from(k), span.to, epoch.channels[k].rate_hz,
                                           memory_of(earlier[k]));
    });
    return earlier;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& root, const Epoch& epoch,
                                            const Span& span) {
    std::vector<std::filesystem::path> files;
    for (std::size_t k = 0; k < epoch.channels.size(); ++k) {
        const auto of_channel = archive::day_files(root / "archive", epoch.codes,
                                                   epoch.channels[k].code, span.from(k), span.to);
        files.insert(files.end(), of_channel.begin(), of_channel.end());
    }
    return files;
}

UtcTime last_sample(const archive::ChannelData& channel) {
    const archive::Segment& last = channel.segments.back();
    return last.time_of(last.counts.size() - 1);
}

std::optional<UtcTime> add_journaled(std::vector<archive::ChannelData>& samples,
                                     const std::filesystem::path& root, const Epoch& epoch,
                                     const Span& span) {
    UtcTime archived = span.to;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (!samples[k].segments.empty())
            archived = std::min(archived, last_sample(samples[k]));
        else if (k != kOuter)
            archived = std::min(archived, span.from(k));
    }
    if (archived > span.to - std::chrono::seconds(1)) return std::nullopt;
    const auto read = [&] {
        return archive::JournalTail(root / "journal", epoch.codes, archived, span.to);
    };
    const archive::JournalTail tail = [&] {
        try {
            return read();
        } catch (const std::system_error&) {
            return read();
        }
    }();
    for (std::size_t k = 0; k < samples.size(); ++k)
        tail.append_to(samples[k], epoch.channels[k].code, span.from(k), span.to);
    return tail.end();
}

std::vector<archive::AbsentFile> absent_files(const std::filesystem::path& root, UtcTime from,
                                              UtcTime to) {
    const auto epochs = station::read_station_epochs(root / "metadata" / "station.xml");
    std::vector<archive::AbsentFile> absent;
    for (auto epoch = epochs.begin(); epoch != epochs.end(); ++epoch) {
        const auto& [start, station] = *epoch;
        const auto next = std::next(epoch);
        const UtcTime begin = epoch == epochs.begin() ? from : std::max(from, start);
        const UtcTime end = next == epochs.end() ? to : std::min(to, next->first);
        if (begin >= end) continue;
        std::vector<std::string> channels;
        for (const station::ChannelScale& channel : station.channels)
            if (!archive::is_derived(channel.code)) channels.push_back(channel.code);
        for (auto& one :
             archive::absent_day_files(root / "archive", station.codes, channels, begin, end))
            if (std::ranges::find(absent, one) == absent.end()) absent.push_back(std::move(one));
    }
    return absent;
}

text::Message to_message(const archive::AbsentFile& absent) {
    if (!absent.compressed.empty())
        return text::message("{} of {} is compressed and not read: unpack {}", absent.channel,
                             to_rfc3339(absent.day).substr(0, 10), absent.compressed.string());
    return text::message(
        "{} has no day file of {}, but another channel has one: copy the archive again, or write "
        "it again with retime",
        absent.channel, to_rfc3339(absent.day).substr(0, 10));
}

text::Message rate_remark(std::span<const archive::ChannelData> samples) {
    std::vector<std::string> names;
    const archive::RateConflict* first = nullptr;
    for (const archive::ChannelData& channel : samples) {
        if (!channel.rate_conflict) continue;
        if (first == nullptr) first = &*channel.rate_conflict;
        names.push_back(channel.rate_conflict->channel);
    }
    if (first == nullptr) return {};
    const double other_hz =
        first->used_hz == first->metadata_hz ? first->header_hz : first->metadata_hz;
    return text::message(
        "{}: the headers of the records say {:.6g} Hz, the metadata {:.6g} Hz, and their starts "
        "give {:.2f} Hz. {:.6g} Hz are used; with {:.6g} Hz samples would be up to {:.2f} s from "
        "their time",
        text::joined(names), first->header_hz, first->metadata_hz, first->observed_hz,
        first->used_hz, other_hz, first->longest_s * std::abs(first->observed_hz / other_hz - 1.0));
}

void add_damage(std::vector<text::Message>& warnings, const archive::ChannelData& channel) {
    for (const archive::Damage& damage : channel.damage)
        warnings.push_back(
            damage.is_of_another_station
                ? text::message("{}: offset {}: {} bytes are a record of another station",
                                damage.file.filename().string(), damage.offset, damage.byte_count)
                : text::message("{}: offset {}: {} bytes are not a record",
                                damage.file.filename().string(), damage.offset, damage.byte_count));
}

}  // namespace a351::corrector::archive_series
