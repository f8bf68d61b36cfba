#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `retime`: an archive written anew from its journal, with times from both sides.
void add_retime_command(CLI::App& program);

}  // namespace a351::corrector
