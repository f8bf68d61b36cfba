// Prints the contents of a journal in order: a line `SESSION UTC_NS` for every header, with the
// host's UTC at which it was written, and a line `INDEX COUNT X Y Z TEMPERATURE` for every sample.
//   journal-samples JOURNAL

#include <iostream>

#include "protocol/archive/archiver.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace {

using namespace a351;

class Printer final : public archive::Sink {
public:
    void record(const std::string&, const archive::PackedRecord&, std::int64_t) override {}
    void sample(const archive::Sample& sample) override {
        const wire::BurstValues& values = sample.values;
        std::cout << sample.index << ' ' << values.count << ' ' << values.axes[0] << ' '
                  << values.axes[1] << ' ' << values.axes[2] << ' ' << values.temperature << '\n';
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: journal-samples JOURNAL\n";
        return 2;
    }
    Printer printer;
    archive::Archiver archiver(printer);
    journal::Sequence chunks(journal::segment_files(argv[1]));
    while (const auto chunk = chunks.next()) {
        if (const auto* const header = std::get_if<journal::Header>(&*chunk))
            std::cout << header->session.to_hex() << ' '
                      << header->clock.realtime.time_since_epoch().count() << '\n';
        archiver.take(*chunk);
    }
}
