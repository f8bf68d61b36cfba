#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace a351::corrector {

/// Adds --figures, which may be repeated.
void add_figures_option(CLI::App& command, std::vector<std::string>& formats);

}  // namespace a351::corrector
