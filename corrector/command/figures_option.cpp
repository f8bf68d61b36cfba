#include "corrector/command/figures_option.hpp"

#include "corrector/figure/drawing.hpp"

namespace a351::corrector {

void add_figures_option(CLI::App& command, std::vector<std::string>& formats) {
    command
        .add_option("--figures", formats,
                    "Format of the report's figures besides SVG: pdf or png; may be repeated")
        ->allow_extra_args(false)
        ->check(CLI::IsMember(picture_formats()));
}

}  // namespace a351::corrector
