#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// Adds `export`: a channel on an exact grid of UTC.
void add_export_command(CLI::App& program);

}  // namespace a351::corrector
