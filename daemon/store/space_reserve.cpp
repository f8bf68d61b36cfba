#include "daemon/store/space_reserve.hpp"

#include <array>
#include <system_error>
#include <utility>

#include "protocol/text/catalogue.hpp"

namespace a351::daemon::store {

SpaceReserve::SpaceReserve(files::FileLayer& files, std::filesystem::path file,
                           std::uint64_t size_bytes)
    : files_(files), file_(std::move(file)), size_bytes_(size_bytes) {
    if (std::filesystem::exists(file_)) make();  // In a copied root the file may have no blocks.
    tend();
}

bool SpaceReserve::give_up() {
    const std::lock_guard lock(disk_mutex_);
    if (state_ != State::present) return false;
    files_.remove(file_);
    state_ = State::given_up;
    ++times_given_up_;
    files_.sync_directory(file_.parent_path());
    return true;
}

void SpaceReserve::tend() {
    const std::lock_guard lock(disk_mutex_);
    const auto free_bytes = files_.free_bytes(file_.parent_path());
    is_little_free_ = free_bytes && *free_bytes < size_bytes_;
    if (state_ == State::given_up && (!free_bytes || *free_bytes > 2 * size_bytes_)) make();
}

void SpaceReserve::make() {
    try {
        files_.allocate(file_, size_bytes_);
        state_ = State::present;
        return;
    } catch (const std::system_error& error) {
        if (!files::is_disk_full(error.code())) {
            state_ = State::unavailable;
            const std::lock_guard lock(trouble_mutex_);
            trouble_ = error.what();
        }
    }
    try {
        files_.remove(file_);  // It may occupy some of the space.
    } catch (const std::system_error&) {
        // The file was not created, or its removal is tried again later.
    }
}

bool SpaceReserve::is_space_short() const noexcept {
    return state_ == State::given_up || is_little_free_;
}

SpaceReserve::Status SpaceReserve::status() const {
    const std::lock_guard lock(trouble_mutex_);
    return {state_, trouble_, times_given_up_, is_space_short()};
}

const char* to_text(SpaceReserve::State state) {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("present"), "given_up", text::marked("unavailable")};
    return kTexts.at(static_cast<std::size_t>(state));
}

}  // namespace a351::daemon::store
