#pragma once
/// @file
/// What the pages of the corrector share.

#include <string>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// The pictures with their captions; small ones two beside each other, after the others.
[[nodiscard]] std::string figures_html(const std::vector<Figure>& figures, const Drawing& drawing);

/// One line however many figures have the same trouble.
[[nodiscard]] std::vector<std::string> missing_lines(const std::vector<std::string>& troubles);

/// @param html  escaped already; the title is not.
[[nodiscard]] std::string section(const std::string& title, const std::string& html);

/// figures/NAME.gp and .dat, then the pictures, which are moved from.
void add_figure_files(std::vector<text::NamedText>& files, const std::vector<Figure>& figures,
                      Drawing& drawing);

}  // namespace a351::corrector
