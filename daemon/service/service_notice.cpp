#include "daemon/service/service_notice.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace a351::daemon::service {

ServiceNotice ServiceNotice::from_environment() {
    const char* const socket = std::getenv("NOTIFY_SOCKET");  // NOLINT(concurrency-mt-unsafe)
    return ServiceNotice(socket == nullptr ? "" : socket);
}

void ServiceNotice::beat(bool is_alive, std::string_view text) {
    if (is_alive) send("WATCHDOG=1");
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    if (line != text_ && send("STATUS=" + line)) text_ = line;
}

bool ServiceNotice::send(std::string_view lines) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (socket_.empty() || socket_.size() >= sizeof address.sun_path) return false;
    std::memcpy(address.sun_path, socket_.data(), socket_.size());
    if (socket_.front() == '@') address.sun_path[0] = '\0';
    const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return false;
    const auto sent =
        sendto(descriptor, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
               reinterpret_cast<const sockaddr*>(&address),
               static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size()));
    close(descriptor);
    return sent >= 0;
}

}  // namespace a351::daemon::service
