#pragma once

#include <optional>
#include <string>
#include <vector>

namespace a351::daemon::ctl {

/// Exit statuses.
inline constexpr int kDone = 0;
inline constexpr int kRefused = 1;
inline constexpr int kUsage = 2;
inline constexpr int kNoDaemon = 3;  ///< Also bad usage of `status`, as for monitoring plugins.

/// The command line; texts that were not given are empty.
struct Arguments {
    std::vector<std::string> urls{"http://127.0.0.1:8351"};
    std::string clock;
    std::string token;
    bool json = false;
    std::string stay;
    std::string site;
    std::vector<std::string> stay_and_site;
    std::string at, from, to;
    std::string operator_name;
    std::string note;
    std::string reason;
    std::string face;
    std::string address;
    std::string out;
    std::optional<int> set_ups;
    double latitude_deg = 0.0, longitude_deg = 0.0;
    std::optional<double> height_m, gravity_mgal;
};

/// Writes a line of this program to stderr, without control characters.
void complain(const std::string& text);

/// Carries out a command of the command line, writes its answer to stdout, and returns the exit
/// status.
/// @param command  name of the subcommand.
/// @throws NoDaemon, InputError
[[nodiscard]] int run_command(const std::string& command, const Arguments& arguments);

}  // namespace a351::daemon::ctl
