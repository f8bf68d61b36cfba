#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `smooth`: the trend of one column of a CSV, as CSV `index,value,standard_error,weight`.
void add_smooth_command(CLI::App& program);

}  // namespace a351::corrector
