#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `decimate`: one column of a CSV at a lower rate, as CSV `index,value,valid`.
void add_decimate_command(CLI::App& program);

}  // namespace a351::corrector
