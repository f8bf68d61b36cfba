#include <CLI/CLI.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "daemon/stream/sender.hpp"
#include "protocol/core/input_error.hpp"

namespace {

using namespace a351;
using namespace a351::daemon::stream;

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2;

void say(const std::string& line) { std::fprintf(stderr, "a351-stream: %s\n", line.c_str()); }

int fail(const std::string& reason, int status) {
    say(reason);
    return status;
}

UtcTime parse_from(const std::string& text) {
    const auto from = parse_rfc3339(text);
    if (!from)
        throw InputError("--from = " + text +
                         ": not an instant; allowed: RFC 3339, for example 2026-03-01T00:00:00Z");
    return *from;
}

void require_paths(const std::filesystem::path& root, const std::filesystem::path& state) {
    if (!std::filesystem::is_directory(root))
        throw InputError(root.string() + ": not a directory; allowed: a data root");
    if (state.empty()) return;
    const auto folder = std::filesystem::absolute(state).parent_path();
    if (!std::filesystem::is_directory(folder))
        throw InputError("--state = " + state.string() + ": " + folder.string() +
                         " is not a directory; allowed: a file in an existing directory");
}

/// Runs until the sender ends, or until SIGINT or SIGTERM.
void run(Sender& sender) {
    asio::io_context io(1);
    asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&](const error_code&, int) { io.stop(); });
    std::exception_ptr fault;
    asio::co_spawn(io, sender.run(), [&](std::exception_ptr thrown) {
        fault = thrown;
        io.stop();
    });
    io.run();
    if (fault) std::rethrow_exception(fault);
    sender.save();
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Sends the records of a data root to a ringserver, as they are made.",
                 "a351-stream");
    app.set_version_flag("--version", std::string("a351-stream ") + A351_VERSION);
    std::string root, ring, from;
    SenderOptions options;
    app.add_option("ROOT", root, "Data root of a351d")->type_name("")->required();
    app.add_option("RING", ring,
                   "Address of the DataLink server, HOST[:PORT], or [ADDRESS][:PORT] for IPv6; "
                   "default port: 16000")
        ->type_name("")
        ->required();
    app.add_option(
           "--from", from,
           "First data to send to a new ring: begin with the first record that ends at or after "
           "this time (RFC 3339); default: the oldest record")
        ->type_name("WHEN");
    std::string state;
    app.add_option(
           "--state", state,
           "File that keeps the last acknowledged record of each stream; use one file for each "
           "server; default: none")
        ->type_name("FILE");
    app.add_flag("--once", options.is_once, "Send all records that there are, then exit");
    try {
        app.parse(argc, argv);
        require_paths(root, state);
        options.archive = std::filesystem::path(root) / "archive";
        options.state = state;
        options.ring = parse_address(ring);
        if (!from.empty()) options.from = parse_from(from);
        Sender sender(std::move(options), say);
        run(sender);
        return kDone;
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return fail(error.what(), kBadUsage);
    } catch (const InputError& error) {
        return fail(error.what(), kBadUsage);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
