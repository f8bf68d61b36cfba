#include "daemon/bundle/bundle.hpp"

#include <algorithm>
#include <utility>

#include "daemon/bundle/open_file.hpp"
#include "daemon/bundle/recorded_files.hpp"
#include "daemon/bundle/tar.hpp"

namespace a351::daemon::bundle {
namespace {

std::string sum_line(const std::string& digest, const std::string& name) {
    return digest + "  " + name + '\n';
}

}  // namespace

void Bundle::add(TextFile file) {
    const std::uint64_t size = file.content.size();
    entries_.push_back(
        {std::move(file.name), size, contents_.now,
         [content = std::move(file.content)](std::uint64_t offset, std::uint64_t count) {
             return content.substr(offset, count);
         }});
}

std::uint64_t Bundle::open() {
    for (TextFile& file : contents_.texts) add(std::move(file));
    for (RecordedFile& file : recorded_files(contents_.root, contents_.from)) {
        const auto [name, size, time] = std::tuple(file.name, file.size, file.time);
        entries_.push_back(
            {name, size, time, [file = std::move(file)](std::uint64_t offset, std::uint64_t count) {
                 return file.read(offset, count);
             }});
    }
    std::uint64_t size_of_sums = 0;
    for (const Entry& entry : entries_)
        size_of_sums += sum_line(text::Sha256().hex(), entry.name).size();
    entries_.push_back({kChecksums, size_of_sums, contents_.now,
                        [this](std::uint64_t offset, std::uint64_t count) {
                            return sums_.substr(offset, count);
                        }});
    std::uint64_t size = kTarEnd;
    for (const Entry& entry : entries_) size += kTarBlock + entry.size + tar_padding(entry.size);
    return size;
}

std::string Bundle::next() {
    std::string piece;
    while (piece.size() < kPiece && entry_ < entries_.size()) {
        const Entry& entry = entries_[entry_];
        if (offset_ == 0)
            piece += tar_header({contents_.folder + '/' + entry.name, entry.size, entry.time});
        const std::string content = entry.read(offset_, std::min(kPiece, entry.size - offset_));
        digest_.update(content);
        piece += content;
        offset_ += content.size();
        if (offset_ < entry.size) continue;
        piece.append(tar_padding(entry.size), '\0');
        sums_ += sum_line(digest_.hex(), entry.name);
        offset_ = 0;
        ++entry_;
    }
    if (entry_ == entries_.size() && !std::exchange(is_over_, true)) piece.append(kTarEnd, '\0');
    return piece;
}

}  // namespace a351::daemon::bundle
