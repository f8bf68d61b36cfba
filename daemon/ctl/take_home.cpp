#include "daemon/ctl/take_home.hpp"

#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>

#include "daemon/bundle/bundle_check.hpp"
#include "daemon/ctl/requests.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/progress_bar.hpp"
#include "protocol/text/removed_at_end.hpp"

namespace a351::daemon::ctl {
namespace {

constexpr std::uint64_t kBetweenSyncs = std::uint64_t{4} << 20U;
constexpr double kMegabyte = 1e6;

volatile std::sig_atomic_t is_interrupted = 0;

/// Lets the first SIGINT, SIGTERM or SIGHUP end the work, which then removes its file.
class Interruptible {
public:
    Interruptible() {
        struct sigaction action {};
        action.sa_handler = [](int) { is_interrupted = 1; };
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
        std::signal(SIGXFSZ, SIG_IGN);  // A limit of the shell becomes an error of the disk.
    }
};

void require_uninterrupted() {
    if (is_interrupted != 0) throw std::runtime_error(text::tr("interrupted; nothing was saved"));
}

/// Returns what is wrong with the disk, and what to do.
std::string disk_trouble(const std::system_error& error, const std::filesystem::path& folder,
                         std::uint64_t size) {
    if (files::is_disk_full(error.code()))
        return text::tr("the disk of {} is full, the copy needs {} MB; nothing was saved",
                        folder.string(), megabytes(size));
    if (error.code() == std::errc::file_too_large)
        return text::tr("the disk of {} takes no file of {} MB; nothing was saved", folder.string(),
                        megabytes(size));
    return text::tr("the copy could not be written: {}; nothing was saved", error.what());
}

/// Returns the time in the name NETWORK_STATION_20260314T080000Z of a day.
std::optional<UtcTime> time_of(std::string name) {
    name.erase(0, name.rfind('_') + 1);
    for (const std::size_t place : {4U, 7U, 13U, 16U})
        if (place < name.size()) name.insert(place, 1, place < 10 ? '-' : ':');
    return parse_rfc3339(name);
}

/// Returns true if a file is a copy that was made less than a survey's night before the bundle of
/// this name: then it has no other day.
bool is_earlier_copy(const std::filesystem::path& file, const std::string& day) {
    // ustar (POSIX.1-1988): the name is in the first 100 bytes of a header, "ustar" at 257.
    std::array<char, 512> header{};
    std::ifstream(file, std::ios::binary).read(header.data(), header.size());
    if (std::string_view(header.data() + 257, 5) != "ustar") return false;
    header[100] = '\0';
    const std::string earlier = std::filesystem::path(header.data()).begin()->string();
    const auto then = time_of(earlier), now = time_of(day);
    const bool is_near = then && now && *then <= *now && *now - *then < events::kSurveyNight;
    return earlier == day ||
           (is_near && earlier.substr(0, earlier.rfind('_')) == day.substr(0, day.rfind('_')));
}

/// The copy under a temporary name.
class Copy {
public:
    Copy(files::FileLayer& files, const std::filesystem::path& out) : files_(files), out_(out) {}

    void begin(std::uint64_t size, const std::string& name) {
        size_ = size;
        if (std::filesystem::is_directory(out_)) out_ /= name;
        folder_ = out_.has_parent_path() ? out_.parent_path() : ".";
        out_ = folder_ / out_.filename();
        const auto there = std::filesystem::symlink_status(out_);
        if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
            throw std::runtime_error(
                text::tr("{} is not a file; nothing was saved", out_.string()));
        if (std::filesystem::exists(there) &&
            !is_earlier_copy(out_, std::filesystem::path(name).stem()))
            throw std::runtime_error(
                text::tr("{} exists and is no copy of the last hours; nothing was saved; name "
                         "another file, or a folder",
                         out_.string()));
        const auto free = files_.free_bytes(folder_);
        if (free && *free < size)
            throw std::system_error(ENOSPC, std::generic_category(), out_.string());
        temporary_ = std::make_unique<text::RemovedAtEnd>(
            folder_ / fmt::format(".{}.{}.part", out_.filename().string(), ::getpid()));
        file_ = files_.create(temporary_->path());
    }

    void take(std::string_view piece) {
        require_uninterrupted();
        file_->append(std::as_bytes(std::span(piece)));
        if (file_->size() - synced_ >= kBetweenSyncs) sync();
        bar_(megabytes_of(file_->size()), megabytes_of(size_));
    }

    /// Checks the copy and gives it its name.  @return the number of files in it
    std::size_t finish() {
        sync();
        file_.reset();
        const std::size_t count =
            bundle::check_bundle(temporary_->path(), [&](std::size_t done, std::size_t all) {
                require_uninterrupted();
                bar_(megabytes_of(done), megabytes_of(all));
            });
        files_.rename(temporary_->path(), out_);
        try {
            files_.sync_directory(folder_);
        } catch (const std::system_error& error) {
            throw std::runtime_error(text::tr(
                "{} is complete and compared, but then its disk failed: {}; save it on another one",
                out_.string(), error.what()));
        }
        return count;
    }

    [[nodiscard]] const std::filesystem::path& out() const noexcept { return out_; }
    [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

private:
    static std::size_t megabytes_of(std::uint64_t bytes) {
        return static_cast<std::size_t>(static_cast<double>(bytes) / kMegabyte);
    }
    void sync() {
        file_->sync();
        synced_ = file_->size();
    }

    files::FileLayer& files_;
    std::filesystem::path out_, folder_;
    std::uint64_t size_ = 0, synced_ = 0;
    std::unique_ptr<text::RemovedAtEnd> temporary_;
    std::unique_ptr<files::AppendFile> file_;
    text::ProgressBar bar_{"MB"};
};

}  // namespace

std::string take_home(const Client& client, files::FileLayer& files,
                      const std::filesystem::path& out) {
    const Interruptible signals;
    const auto start = std::chrono::steady_clock::now();
    Copy copy(files, out);
    try {
        const Reply reply = client.get_file(
            "/api/bundle",
            {[&](std::uint64_t size, const std::string& name) { copy.begin(size, name); },
             [&](std::string_view piece) { copy.take(piece); }});
        constexpr int kGood = 200;
        if (reply.status != kGood) throw std::runtime_error(answer_of(reply).error);
        const std::size_t count = copy.finish();
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        return text::tr("{}: {} MB, {} files, {} s; read back and compared", copy.out().string(),
                        megabytes(copy.size()), count, fmt::format("{:.0f}", time.count()));
    } catch (const bundle::BadBundle& error) {
        throw std::runtime_error(text::tr("{}; nothing was saved, try another disk", error.what()));
    } catch (const std::system_error& error) {
        throw std::runtime_error(disk_trouble(error, copy.folder(), copy.size()));
    }
}

}  // namespace a351::daemon::ctl
