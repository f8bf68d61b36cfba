#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `table`: a survey from averages per occupation.
void add_table_command(CLI::App& program);

}  // namespace a351::corrector
