// Prints one line for each channel of an archive: `channel=C samples=N first=UTC last=UTC`.
// With a directory OUT, also writes the counts of each channel to OUT/C, one on each line.
//   archive-samples ARCHIVE [OUT]

#include <fstream>
#include <iostream>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/sds.hpp"

using namespace a351;

int main(int argc, char** argv) {
    using namespace a351;
    if (argc != 2 && argc != 3) {
        std::cerr << "usage: archive-samples ARCHIVE [OUT]\n";
        return 2;
    }
    const journal::StationCodes codes;
    for (const std::string& channel : archive::channels_in(argv[1], codes)) {
        const auto data =
            archive::read_channel(argv[1], codes, channel, UtcTime::min(), UtcTime::max());
        if (!data.damage.empty()) {
            std::cerr << data.damage.front().file.string() << ": damaged\n";
            return 1;
        }
        std::size_t samples = 0;
        std::ofstream out;
        if (argc == 3) out.open(std::filesystem::path(argv[2]) / channel);
        for (const auto& segment : data.segments) {
            samples += segment.counts.size();
            if (!out.is_open()) continue;
            for (const auto counts : segment.counts) out << counts << '\n';
        }
        if (samples == 0) continue;
        const auto& last = data.segments.back();
        std::cout << "channel=" << channel << " samples=" << samples
                  << " first=" << to_rfc3339(data.segments.front().time_of(0), 6)
                  << " last=" << to_rfc3339(last.time_of(last.counts.size() - 1), 6) << '\n';
    }
}
