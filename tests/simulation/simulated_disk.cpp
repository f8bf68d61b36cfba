#include "tests/simulation/simulated_disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace a351::simulation {
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kFree_bytes = std::uint64_t{64} << 30;

}  // namespace

class SimulatedDisk::File final : public test::ForwardingFile {
public:
    File(SimulatedDisk& disk, fs::path path, std::unique_ptr<files::AppendFile> file)
        : ForwardingFile(std::move(file)), disk_(disk), path_(std::move(path)) {}

    void append(std::span<const std::byte> bytes) override {
        try {
            disk_.operate(Operation::append, path_);
        } catch (...) {
            file_->append(bytes.first(bytes.size() / 2));
            throw;
        }
        file_->append(bytes);
    }
    void sync() override {
        std::uint64_t& synced = disk_.synced_sizes_[path_];
        try {
            disk_.operate(Operation::sync, path_);
        } catch (...) {
            disk_.zero_pages(path_, synced);
            disk_.files_with_holes_.insert(path_);
            throw;
        }
        synced = size();
        disk_.touch(path_);
    }

private:
    SimulatedDisk& disk_;
    fs::path path_;
};

SimulatedDisk::SimulatedDisk(std::uint64_t seed, Schedule& schedule, Host& host, fs::path root)
    : schedule_(schedule),
      host_(host),
      root_(std::move(root)),
      kept_(root_.parent_path() / "kept"),
      random_(seed, "disk") {
    fs::create_directories(root_);
    fs::create_directories(kept_);
}

void SimulatedDisk::trouble(Trouble kind, Part part, Nanoseconds end) {
    trouble_ = kind;
    part_ = part;
    trouble_end_ = end;
}

bool SimulatedDisk::is_affected(const fs::path& file) const {
    if (!is_in_trouble()) return false;
    const std::string name = file.string();
    switch (part_) {
        case Part::journal:
            return name.find("/journal") != std::string::npos;
        case Part::archive:
            return name.find("/archive") != std::string::npos;
        case Part::all:
            break;
    }
    return true;
}

/// Carries out the trouble of an operation.  The thread can lose its turn before the operation.
void SimulatedDisk::operate(Operation operation, const fs::path& file) {
    schedule_.yield();
    while (trouble_ == Trouble::hangs && is_affected(file)) schedule_.sleep_until(trouble_end_);
    if (!is_affected(file)) return;
    const bool takes_space = operation == Operation::append || operation == Operation::takes_space;
    if (trouble_ == Trouble::fails)
        throw std::system_error(EIO, std::generic_category(), "simulated: " + file.string());
    if (trouble_ == Trouble::is_full && takes_space)
        throw std::system_error(ENOSPC, std::generic_category(), "simulated: " + file.string());
}

/// Gives a file the present time of the host, as the kernel does.
void SimulatedDisk::touch(const fs::path& file) const {
    const auto now = host_.read(CLOCK_REALTIME);
    const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
    const timespec time{seconds.count(), (now - seconds).count()};
    const timespec times[2] = {time, time};
    ::utimensat(AT_FDCWD, file.c_str(), times, 0);
}

std::unique_ptr<files::AppendFile> SimulatedDisk::open_append(const fs::path& file) {
    operate(Operation::takes_space, file);
    if (!fs::exists(file)) changes_[file.parent_path()].push_back({{}, file, {}});
    return std::make_unique<File>(*this, file, files_.open_append(file));
}

void SimulatedDisk::create_directories(const fs::path& directory) {
    if (fs::exists(directory)) return;
    create_directories(directory.parent_path());
    operate(Operation::takes_space, directory);
    fs::create_directory(directory);
    changes_[directory.parent_path()].push_back({{}, directory, {}});
    sync_directory(directory.parent_path());
}

void SimulatedDisk::sync_directory(const fs::path& directory) {
    operate(Operation::sync, directory);
    for (const Change& change : std::exchange(changes_[directory], {}))
        if (!change.kept.empty()) fs::remove(change.kept);
}

void SimulatedDisk::truncate(const fs::path& file, std::uint64_t size) {
    operate(Operation::other, file);
    fs::resize_file(file, size);
    synced_sizes_[file] = size;
    touch(file);
}

fs::path SimulatedDisk::keep(const fs::path& file) {
    fs::path kept = kept_ / std::to_string(++kept_count_);
    fs::rename(file, kept);
    synced_sizes_[kept] = std::exchange(synced_sizes_[file], 0);
    return kept;
}

void SimulatedDisk::rename(const fs::path& from, const fs::path& to) {
    operate(Operation::other, from);
    Change change{from, to, {}};
    if (fs::exists(to)) change.kept = keep(to);
    fs::rename(from, to);
    synced_sizes_[to] = std::exchange(synced_sizes_[from], 0);
    changes_[to.parent_path()].push_back(std::move(change));
}

void SimulatedDisk::remove(const fs::path& file) {
    operate(Operation::other, file);
    if (!fs::exists(file)) return files_.remove(file);  // It throws.
    changes_[file.parent_path()].push_back({file, {}, keep(file)});
}

void SimulatedDisk::allocate(const fs::path& file, std::uint64_t size) {
    operate(Operation::takes_space, file);
    if (!fs::exists(file)) changes_[file.parent_path()].push_back({{}, file, {}});
    std::ofstream(file, std::ios::app).close();
    if (fs::file_size(file) < size) fs::resize_file(file, size);
    synced_sizes_[file] = size;
}

std::optional<std::uint64_t> SimulatedDisk::free_bytes(const fs::path& directory) const {
    return trouble_ == Trouble::is_full && is_affected(directory) ? 0 : kFree_bytes;
}

void SimulatedDisk::cut_power() {
    trouble_end_ = schedule_.now();
    for (auto& [directory, changes] : changes_) {
        const auto survive = static_cast<std::size_t>(random_.bits() % (changes.size() + 1));
        for (std::size_t i = changes.size(); i > survive; --i) undo(changes[i - 1]);
    }
    changes_.clear();
    std::vector<fs::path> names;
    for (const auto& entry : fs::recursive_directory_iterator(root_))
        if (entry.is_regular_file()) names.push_back(entry.path());
    std::ranges::sort(names);
    for (const fs::path& file : names) {
        std::uint64_t& synced = synced_sizes_[file];
        const std::uint64_t size = fs::file_size(file);
        if (size > synced) {
            fs::resize_file(file, synced + random_.bits() % (size - synced + 1));
            zero_pages(file, synced);
        }
        synced = fs::file_size(file);
    }
}

void SimulatedDisk::undo(const Change& change) {
    const auto move = [&](const fs::path& from, const fs::path& to) {
        if (!fs::exists(from)) return;
        fs::rename(from, to);
        synced_sizes_[to] = std::exchange(synced_sizes_[from], 0);
    };
    if (!change.to.empty() && !change.from.empty()) move(change.to, change.from);
    if (change.from.empty()) fs::remove_all(change.to);
    if (!change.kept.empty()) move(change.kept, change.to.empty() ? change.from : change.to);
}

/// Makes random pages behind the first `synced` bytes zero.
void SimulatedDisk::zero_pages(const fs::path& file, std::uint64_t synced) {
    constexpr std::uint64_t kPage = 4096;
    const std::uint64_t size = fs::file_size(file);
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    for (std::uint64_t page = synced / kPage; page * kPage < size; ++page) {
        if (random_.bits() % 4 != 0) continue;
        const auto from = std::max(page * kPage, synced);
        const std::string zeros(std::min((page + 1) * kPage, size) - std::min(from, size), '\0');
        out.seekp(static_cast<std::streamoff>(from));
        out.write(zeros.data(), static_cast<std::streamsize>(zeros.size()));
    }
}

}  // namespace a351::simulation
