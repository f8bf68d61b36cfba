/// @file
/// Requests to the page with any head and body.  The Guard must refuse changes without its token,
/// the Api must answer each request with one of its status codes and valid JSON, and GET must
/// change nothing.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "daemon/live/live_record.hpp"
#include "daemon/page/api.hpp"
#include "daemon/page/guard.hpp"
#include "protocol/wire/device_profile.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

namespace {

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::live;
using namespace a351::daemon::page;
using namespace a351::daemon::status;
using namespace a351::daemon::survey;
using fuzz::require;

const std::string kToken = "0123456789abcdef0123456789abcdef";

/// Parses "METHOD target", lines "Name: value", an empty line and the body.
Request request_of(std::string_view input) {
    Request request;
    const auto line = [&] {
        const auto end = std::min(input.find('\n'), input.size());
        const std::string taken(input.substr(0, end));
        input.remove_prefix(std::min(end + 1, input.size()));
        return taken;
    };
    const std::string first = line();
    const auto blank = std::min(first.find(' '), first.size());
    request.method = first.substr(0, blank);
    request.target = first.substr(std::min(blank + 1, first.size()));
    while (!input.empty()) {
        const std::string header = line();
        if (header.empty()) break;
        const auto colon = std::min(header.find(": "), header.size());
        request.headers.emplace_back(header.substr(0, colon),
                                     header.substr(std::min(colon + 2, header.size())));
    }
    request.body = input;
    return request;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Request request = request_of(fuzz::text_of(data, size));
    const Guard guard(8351, {"gravbox"}, kToken);
    const auto refused = guard.refuse(request);
    const bool is_reading = request.method == "GET" || request.method == "HEAD";
    if (refused) require(refused->status == 421 || refused->status == 403);
    if (!refused && !is_reading) {
        const auto tokens = request.values("X-A351-Token");
        require(std::find(tokens.begin(), tokens.end(), kToken) != tokens.end());
    }

    FakeRecorder recorder;
    Occupations occupations(recorder, two_sites(), {});
    static live::Record live(*wire::find_profile("A351"), 50, {});
    Api api({.status = [] { return Status(); },
             .occupations = occupations,
             .live = live,
             .events = [&] { return recorder.log; },
             .gravity_so_far = [] { return std::string("{}"); }},
            kToken);
    const Response response = api.answer(request);
    require(std::set{200, 400, 404, 405, 409}.contains(response.status));
    if (response.content_type == "application/json") require(nlohmann::json::accept(response.body));
    if (is_reading) require(recorder.log.empty());
    return 0;
}
