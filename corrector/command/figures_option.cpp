#include "corrector/command/figures_option.hpp"

#include "corrector/figure/drawing.hpp"

namespace a351::corrector {

void add_figures_option(CLI::App& command, std::vector<std::string>& formats) {
    command
        .add_option("--figures", formats,
                    "Also write the figures in this format, besides SVG; may be repeated")
        ->type_name("FORMAT")
        ->allow_extra_args(false)
        ->check(CLI::IsMember(picture_formats()));
}

}  // namespace a351::corrector
