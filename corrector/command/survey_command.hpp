#pragma once

namespace CLI {
class App;
}

namespace a351::corrector {

/// `survey`: one or more survey days from the archive.
void add_survey_command(CLI::App& program);

}  // namespace a351::corrector
