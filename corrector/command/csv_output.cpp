#include "corrector/command/csv_output.hpp"

#include <filesystem>
#include <iostream>

namespace a351::corrector::command {

CsvOutput::CsvOutput(const std::string& file) {
    if (file.empty()) return;
    const std::filesystem::path path = std::filesystem::absolute(file);
    std::filesystem::create_directories(path.parent_path());
    file_.emplace(path);
}

void CsvOutput::write(std::string_view text) {
    if (file_) {
        file_->write(text);
    } else {
        std::cout << text;
    }
}

void CsvOutput::finish() {
    if (!file_) return;
    file_->close();
    file_->publish();
}

void write_or_print(const std::string& file, std::string_view csv) {
    CsvOutput output(file);
    output.write(csv);
    output.finish();
}

}  // namespace a351::corrector::command
