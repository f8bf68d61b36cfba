#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `emd`: the modes and the residue of one column of a CSV, as CSV `imf1,...,residue`.
void add_emd_command(CLI::App& program);

}  // namespace a351::corrector
