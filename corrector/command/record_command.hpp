#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `record`: hours to weeks at one point.
void add_record_command(CLI::App& program);

}  // namespace a351::corrector
