#pragma once
/// @file
/// Common parts of the corrector's pages.

#include <string>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// Returns the pictures with their captions; small ones are side by side, after the others.
[[nodiscard]] std::string figures_html(const std::vector<Figure>& figures, const Drawing& drawing);

/// Returns one line for all missing figures: the first reason and the number of others; none
/// without troubles.
[[nodiscard]] std::vector<std::string> missing_lines(const std::vector<std::string>& troubles);

/// Returns a section of a page.
/// @param title  text, escaped here.
/// @param html   content, already escaped.
[[nodiscard]] std::string section(const std::string& title, const std::string& html);

/// Adds figures/NAME.gp and .dat, then the pictures, which are moved out of `drawing`.
void add_figure_files(std::vector<text::NamedText>& files, const std::vector<Figure>& figures,
                      Drawing& drawing);

}  // namespace a351::corrector
