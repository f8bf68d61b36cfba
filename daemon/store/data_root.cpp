#include "daemon/store/data_root.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include "protocol/text/text_file.hpp"

namespace a351::daemon {
namespace {

/// Without the values of the form YYYY-MM-DDT...
std::string without_instants(std::string xml) {
    constexpr std::size_t kDate = std::string_view("2026-03-01").size();
    for (auto at = xml.find('T'); at != std::string::npos; at = xml.find('T', at + 1)) {
        if (at < kDate || xml[at - 3] != '-' || xml[at - 6] != '-') continue;
        const auto end = xml.find_first_of("\"<", at);
        if (end == std::string::npos) break;
        at -= kDate;
        xml.erase(at, end - at);
    }
    return xml;
}

}  // namespace

DataRootLock::DataRootLock(record::FileLayer& files, const std::filesystem::path& root) {
    for (const char* name : {"journal", "archive", "metadata", "events", "state"}) {
        files.create_directories(root / name);
    }
    const std::filesystem::path file = root / "state" / "lock";
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        throw std::system_error(errno, std::generic_category(), "cannot open " + file.string());
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        close(descriptor_);
        throw DataRootLocked(root.string() + ": another a351d records here");
    }
}

DataRootLock::~DataRootLock() { close(descriptor_); }

void describe_station(record::FileLayer& files, const std::filesystem::path& root,
                      const record::StationDescription& description) {
    const std::filesystem::path file = root / "metadata" / "station.xml";
    const std::string xml = record::to_station_xml(description);
    if (std::filesystem::exists(file) &&
        without_instants(text::read_text_file(file)) == without_instants(xml)) {
        return;
    }
    record::replace_file(files, file, std::as_bytes(std::span(xml)));
}

}  // namespace a351::daemon
