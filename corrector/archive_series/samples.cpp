#include "corrector/archive_series/samples.hpp"

#include "corrector/archive_series/on_all_cores.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::corrector::archive_series {

std::vector<archive::ChannelData> read_samples(const std::filesystem::path& root,
                                               const Epoch& epoch, const Span& span) {
    std::vector<archive::ChannelData> samples(epoch.channels.size());
    on_all_cores(samples.size(), [&](std::size_t k) {
        samples[k] = archive::read_channel(root / "archive", epoch.codes, epoch.channels[k].code,
                                           span.from(k), span.to);
    });
    return samples;
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
