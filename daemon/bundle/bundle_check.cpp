#include "daemon/bundle/bundle_check.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include "daemon/bundle/bundle.hpp"
#include "daemon/bundle/open_file.hpp"
#include "daemon/bundle/tar.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sha256.hpp"

namespace a351::daemon::bundle {
namespace {

/// Reads a tar file from its begin to its end.
class TarReader {
public:
    TarReader(const std::filesystem::path& file,
              const std::function<void(std::size_t, std::size_t)>& progress)
        : file_(file), progress_(progress) {
        file_.forget();
    }

    /// Returns the header of the next file; std::nullopt at the end.
    std::optional<TarFile> next() {
        const std::string block = read(kTarBlock);
        if (const auto file = parse_tar_header(block)) return file;
        require_zeros(block);
        require_zeros(read(kTarEnd - kTarBlock));
        if (at_ != file_.size()) damaged();
        return std::nullopt;
    }

    /// Reads the content of the file whose header came last.
    void read_content(std::uint64_t size, const std::function<void(const std::string&)>& take) {
        for (std::uint64_t done = 0; done < size;) {
            const std::string piece = read(std::min(kPiece, size - done));
            take(piece);
            done += piece.size();
        }
        require_zeros(read(tar_padding(size)));
    }

private:
    [[noreturn]] void damaged() const {
        throw BadBundle(text::tr("the copy is damaged before byte {}", at_));
    }
    void require_zeros(const std::string& bytes) const {
        if (bytes.find_first_not_of('\0') != std::string::npos) damaged();
    }
    std::string read(std::uint64_t count) {
        if (at_ + count > file_.size()) throw BadBundle(text::tr("the copy is not complete"));
        std::string bytes = file_.read(at_, count);
        at_ += count;
        if (progress_) progress_(at_, file_.size());
        return bytes;
    }

    const OpenFile file_;
    const std::function<void(std::size_t, std::size_t)>& progress_;
    std::uint64_t at_ = 0;
};

}  // namespace

std::size_t check_bundle(const std::filesystem::path& file,
                         const std::function<void(std::size_t, std::size_t)>& progress) {
    TarReader tar(file, progress);
    std::map<std::string, std::string> digests;
    std::string sums;
    std::size_t count = 0;
    for (auto entry = tar.next(); entry; entry = tar.next(), ++count) {
        const std::string name = entry->name.substr(entry->name.find('/') + 1);
        text::Sha256 digest;
        tar.read_content(entry->size, [&](const std::string& piece) {
            digest.update(piece);
            if (name == kChecksums) sums += piece;
        });
        if (name != kChecksums) digests[name] = digest.hex();
    }
    std::istringstream lines(sums);
    for (std::string digest, name; lines >> digest && std::getline(lines >> std::ws, name);) {
        const auto found = digests.find(name);
        if (found == digests.end() || found->second != digest)
            throw BadBundle(text::tr("the copy of {} differs from the original", name));
        digests.erase(found);
    }
    if (count == 0 || !digests.empty()) throw BadBundle(text::tr("the copy is not complete"));
    return count;
}

}  // namespace a351::daemon::bundle
