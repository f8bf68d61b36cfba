#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `tide`: a series of tides at one place as CSV `time,tide_mgal`.
void add_tide_command(CLI::App& program);

}  // namespace a351::corrector
