#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `a351-correct calibrate`: what is to be known of a unit before a survey, measured.
void add_calibrate_command(CLI::App& program);

}  // namespace a351::corrector
