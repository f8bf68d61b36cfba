/// @file
/// A main() for fuzzers built without libFuzzer: runs each input once whole and once cut in half.
///
///     NAME_fuzz FILE|DIRECTORY...

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

/// Returns the files, sorted so that every run has the same order.
std::set<fs::path> files_of(int count, char** arguments) {
    std::set<fs::path> files;
    for (int i = 1; i < count; ++i) {
        if (fs::is_directory(arguments[i])) {
            for (const auto& entry : fs::directory_iterator(arguments[i]))
                if (entry.is_regular_file()) files.insert(entry.path());
        } else {
            files.insert(arguments[i]);
        }
    }
    return files;
}

}  // namespace

int main(int argc, char** argv) try {
    LLVMFuzzerTestOneInput(nullptr, 0);
    const std::set<fs::path> files = files_of(argc, argv);
    if (files.empty())
        throw std::runtime_error("no seed files; allowed: files, and folders with files");
    for (const fs::path& file : files) {
        std::ifstream in(file, std::ios::binary);
        if (!in) throw std::runtime_error(file.string() + ": cannot be read");
        const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
        const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
        LLVMFuzzerTestOneInput(data, bytes.size());
        LLVMFuzzerTestOneInput(data, bytes.size() / 2);
    }
    std::printf("%zu inputs, each whole and cut in half\n", files.size());
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
