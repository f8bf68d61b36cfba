#include "corrector/command/csv_output.hpp"

#include <filesystem>
#include <iostream>

#include "corrector/survey/result_files.hpp"

namespace a351::corrector {

void write_or_print(const std::string& file, std::string csv) {
    if (file.empty()) {
        std::cout << csv;
        return;
    }
    const std::filesystem::path path = std::filesystem::absolute(file);
    write_together(path.parent_path(), {{path.filename().string(), std::move(csv)}});
}

}  // namespace a351::corrector
