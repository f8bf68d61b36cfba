#include <algorithm>
#include <array>
#include <deque>
#include <mutex>
#include <optional>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/profile_reader.hpp"
#include "protocol/wire/shipped_profiles.hpp"

namespace a351::wire {
namespace {

/// All profiles of this run.  Profiles are added and never removed, so pointers remain valid.
class ProfileList {
public:
    ProfileList() {
        for (const ShippedProfile& file : shipped_profiles()) {
            profiles_.push_back(
                parse_profile(file.toml, std::string(file.name),
                              "config/profiles/" + std::string(file.name) + ".toml"));
        }
    }

    const DeviceProfile* find(std::string_view name) {
        const std::lock_guard lock(mutex_);
        const auto found = std::ranges::find(profiles_, name, &DeviceProfile::name);
        return found == profiles_.end() ? nullptr : &*found;
    }

    const DeviceProfile& add(DeviceProfile profile) {
        const std::lock_guard lock(mutex_);
        const auto found = std::ranges::find(profiles_, profile.name, &DeviceProfile::name);
        return found == profiles_.end() ? profiles_.emplace_back(std::move(profile)) : *found;
    }

private:
    std::mutex mutex_;
    std::deque<DeviceProfile> profiles_;
};

ProfileList& list() {
    static ProfileList profiles;
    return profiles;
}

/// Returns the digits that tell apart two files of the same name: FNV-1a of the content, 32 bits.
std::string digest_of(std::string_view toml) {
    std::uint32_t hash = 0x811C9DC5;
    for (const char c : toml) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193;
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string digits;
    for (unsigned shift = 32; shift > 0;) {
        shift -= 4;
        digits += kDigits[(hash >> shift) & 0xFU];
    }
    return digits;
}

/// Adds a profile that is not shipped; find_profile() then finds it.
const DeviceProfile& add(std::string_view toml, std::string name,
                         const std::filesystem::path& origin) {
    if (const DeviceProfile* const known = list().find(name)) return *known;
    DeviceProfile profile = parse_profile(toml, std::move(name), origin);
    profile.toml = toml;
    return list().add(std::move(profile));
}

bool is_name(std::string_view name) {
    constexpr std::string_view kAllowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";
    return !name.empty() && name.find_first_not_of(kAllowed) == std::string_view::npos;
}

}  // namespace

const DeviceProfile* find_profile(std::string_view name) { return list().find(name); }

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const ShippedProfile& file : shipped_profiles()) names.emplace_back(file.name);
    return names;
}

const DeviceProfile& load_profile(const std::filesystem::path& file) {
    const std::string toml = text::read_text_file(file);
    const auto shipped = std::ranges::find(shipped_profiles(), toml, &ShippedProfile::toml);
    if (shipped != shipped_profiles().end()) return *find_profile(shipped->name);
    const std::string stem = file.stem().string();
    if (!is_name(stem)) {
        throw InputError(text::echoed(file.string()) +
                         ": not a name of a profile; allowed: letters, digits, - _ . and .toml");
    }
    return add(toml, stem + "#" + digest_of(toml), file);
}

const DeviceProfile* named_or_loaded(std::string_view name, const std::filesystem::path& file) {
    if (std::ranges::count(shipped_profiles(), name, &ShippedProfile::name) > 0)
        return find_profile(name);
    return std::filesystem::is_regular_file(file) ? &load_profile(file) : nullptr;
}

const DeviceProfile& profile_option(std::string_view option, const std::string& name_or_file) {
    if (const auto* profile = named_or_loaded(name_or_file, name_or_file)) return *profile;
    throw InputError(std::string(option) + " " + text::echoed(name_or_file) +
                     ": neither a profile nor a file; allowed: " + text::joined(profile_names()) +
                     ", or a file");
}

bool add_recorded_profile(const std::string& name, std::string_view toml) {
    const std::size_t mark = name.rfind('#');
    if (mark == std::string::npos || name.substr(mark + 1) != digest_of(toml)) return false;
    try {
        add(toml, name, name);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace a351::wire
