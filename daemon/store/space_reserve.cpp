#include "daemon/store/space_reserve.hpp"

#include <array>
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
    if (status().state != State::present) return false;
    files_.remove(file_);
    set(State::given_up);
    files_.sync_directory(file_.parent_path());
    return true;
}

void SpaceReserve::tend() {
    const std::lock_guard lock(disk_mutex_);
    const auto free_bytes = files_.free_bytes(file_.parent_path());
    {
        const std::lock_guard state_lock(mutex_);
        free_bytes_ = free_bytes;
    }
    if (status().state == State::given_up && may_create_reserve(free_bytes, size_bytes_)) make();
}

void SpaceReserve::make() {
    try {
        files_.allocate(file_, size_bytes_);
        return set(State::present);
    } catch (const std::system_error& error) {
        if (!files::is_disk_full(error.code())) set(State::unavailable, error.what());
    }
    try {
        files_.remove(file_);  // It may occupy some of the space.
    } catch (const std::system_error&) {
        // The file was not created, or its removal is tried again later.
    }
}

void SpaceReserve::set(State state, const std::string& trouble) {
    const std::lock_guard lock(mutex_);
    if (state == State::given_up) ++status_.times_given_up;
    status_.state = state;
    status_.trouble = trouble;
}

bool SpaceReserve::is_space_short() const {
    const std::lock_guard lock(mutex_);
    return store::is_space_short(status_.state, free_bytes_, size_bytes_);
}

SpaceReserve::Status SpaceReserve::status() const {
    const std::lock_guard lock(mutex_);
    Status status = status_;
    status.is_space_short = store::is_space_short(status_.state, free_bytes_, size_bytes_);
    return status;
}

const char* to_text(SpaceReserve::State state) {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("present"), "given_up", text::marked("unavailable")};
    return kTexts.at(static_cast<std::size_t>(state));
}

}  // namespace a351::daemon::store
