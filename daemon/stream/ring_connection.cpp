#include "daemon/stream/ring_connection.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/error.hpp>
#include <chrono>

#include "protocol/core/input_error.hpp"
#include "protocol/text/echo.hpp"

namespace a351::daemon::stream {
namespace {

/// Time limit of an exchange, the same as ringserver's own for a client (NetIOTimeout, 10 s).
constexpr std::chrono::seconds kPatience{10};

void require(const error_code& error) {
    if (error == boost::beast::error::timeout)
        throw RingError(fmt::format("no answer within {} s", kPatience.count()));
    if (error == asio::error::eof) throw RingError("it closed the connection");
    if (error) throw RingError(error.message());
}

/// Returns a regular expression for the streams of the stations to which `names` belong.
std::string pattern_of(const std::vector<std::string>& names) {
    std::vector<std::string> stations;
    for (const std::string& name : names) stations.push_back(name.substr(0, name.rfind('_') + 1));
    stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
    std::string pattern;
    for (const std::string& station : stations) pattern += (pattern.empty() ? "" : "|") + station;
    return "^(FDSN:)?(" + pattern + ")";
}

}  // namespace

std::string Address::text() const {
    return host.find(':') == std::string::npos ? host + ":" + port : "[" + host + "]:" + port;
}

Address parse_address(std::string_view text) {
    const auto refuse = [&] {
        throw InputError(fmt::format(
            "RING = {}: not an address; allowed: HOST[:PORT], or [ADDRESS][:PORT] for IPv6", text));
    };
    Address address;
    std::string_view rest = text;
    const bool is_bracketed = rest.starts_with('[');
    if (is_bracketed) rest.remove_prefix(1);
    const auto end = std::min(rest.find(is_bracketed ? ']' : ':'), rest.size());
    address.host = rest.substr(0, end);
    rest.remove_prefix(end);
    if (is_bracketed) {
        if (rest.empty()) refuse();
        rest.remove_prefix(1);
    }
    if (!rest.empty()) {
        if (rest.front() != ':') refuse();
        address.port = rest.substr(1);
    }
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto is_clean = [](char c) { return c > ' ' && c < '\x7f' && c != '/' && c != '@'; };
    if (address.host.empty() || !std::ranges::all_of(address.host, is_clean) ||
        address.port.empty() || address.port.size() > 5 ||
        !std::ranges::all_of(address.port, is_digit) || std::stoi(address.port) < 1 ||
        std::stoi(address.port) > 65535)
        refuse();
    return address;
}

asio::awaitable<void> RingConnection::open(const Address& address) {
    error_code error;
    asio::ip::tcp::resolver resolver(stream_.get_executor());
    const auto places = co_await resolver.async_resolve(address.host, address.port, into(error));
    require(error);
    stream_.expires_after(kPatience);
    co_await stream_.async_connect(places, into(error));
    require(error);
    stream_.socket().set_option(asio::ip::tcp::no_delay(true), error);
    const std::string id =
        make_packet(fmt::format("ID a351-stream:a351:{}:a351-" A351_VERSION, getpid()));
    co_await ask(id, "ID");
}

asio::awaitable<void> RingConnection::send(const std::string& bytes) {
    error_code error;
    stream_.expires_after(kPatience);
    co_await asio::async_write(stream_, asio::buffer(bytes), into(error));
    require(error);
}

asio::awaitable<std::string> RingConnection::receive(std::size_t size) {
    std::string bytes(size, '\0');
    error_code error;
    co_await asio::async_read(stream_, asio::buffer(bytes), into(error));
    require(error);
    co_return bytes;
}

/// Reads an answer, which must be of this kind.
asio::awaitable<RingConnection::Answer> RingConnection::answer(std::string_view kind) {
    stream_.expires_after(kPatience);
    // One co_await per statement: g++ 12 destroys temporaries of larger expressions twice.
    const std::string preheader = co_await receive(kPreheader);
    const std::string header = co_await receive(header_length(preheader));
    Answer answer;
    answer.header = parse_header(header);
    answer.data = co_await receive(answer.header.data_size);
    if (answer.header.kind() == "ERROR")
        throw RingError("it refuses: " + text::echoed(answer.data));
    if (answer.header.kind() != kind)
        throw RingError(fmt::format("it answers {} instead of {}", answer.header.kind(), kind));
    co_return answer;
}

asio::awaitable<RingConnection::Answer> RingConnection::ask(const std::string& request,
                                                            std::string_view kind) {
    co_await send(request);
    co_return co_await answer(kind);
}

asio::awaitable<std::map<std::string, std::uint64_t>> RingConnection::latest(
    const std::vector<std::string>& names) {
    const std::string pattern = pattern_of(names);
    const std::string match = make_packet(fmt::format("MATCH {}", pattern.size()), pattern);
    co_await ask(match, "OK");
    const std::string info = make_packet("INFO STREAMS");
    const Answer list = co_await ask(info, "INFO");
    co_return parse_streams(list.data);
}

asio::awaitable<std::uint64_t> RingConnection::earliest() {
    const std::string request = make_packet("POSITION SET EARLIEST");
    const Answer position = co_await ask(request, "OK");
    co_return position.header.value();
}

asio::awaitable<std::string> RingConnection::read(std::uint64_t id) {
    const std::string request = make_packet(fmt::format("READ {}", id));
    Answer packet = co_await ask(request, "PACKET");
    co_return std::move(packet.data);
}

asio::awaitable<std::vector<std::uint64_t>> RingConnection::write(std::span<const Record> records) {
    std::string bytes;
    for (const Record& record : records) bytes += make_write(record);
    co_await send(bytes);
    std::vector<std::uint64_t> ids;
    while (ids.size() < records.size()) {
        const Answer acknowledgement = co_await answer("OK");
        ids.push_back(acknowledgement.header.value());
    }
    co_return ids;
}

}  // namespace a351::daemon::stream
