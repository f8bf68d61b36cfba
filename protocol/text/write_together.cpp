#include "protocol/text/write_together.hpp"

#include <deque>

#include "protocol/text/new_file.hpp"

namespace a351::text {

void write_together(const std::filesystem::path& directory, const std::vector<NamedText>& files) {
    std::deque<NewFile> complete;
    for (const auto& [name, content] : files) {
        std::filesystem::create_directories((directory / name).parent_path());
        NewFile& file = complete.emplace_back(directory / name);
        file.write(content);
        file.close();
    }
    for (NewFile& file : complete) file.publish();
}

}  // namespace a351::text
