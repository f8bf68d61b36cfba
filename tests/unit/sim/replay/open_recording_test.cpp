#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/replay/recording.hpp"
#include "tests/unit/journal/segment_fixture.hpp"

namespace a351::sim::replay {
namespace {

namespace fs = std::filesystem;
using journal::segment_of;

journal::Bytes good_segment(std::uint16_t firmware = 1) {
    auto header = test::journal_header();
    header.firmware = firmware;
    return segment_of({header, test::rx_chunk("\x80"
                                              "ABC",
                                              "DEF\r")});
}

std::string refusal(std::vector<fs::path> files) {
    try {
        static_cast<void>(open_recording({.files = std::move(files)}));
    } catch (const InputError& error) {
        const std::string line = error.what();
        CHECK(line.find('\n') == std::string::npos);
        return line;
    }
    return "accepted";
}

}  // namespace

TEST_CASE("a file that cannot be replayed is refused with its name and what is allowed") {
    const test::TemporaryDirectory directory;
    const fs::path file = directory.path() / "00000001_x.a351j";
    const auto with = [&](std::span<const std::byte> bytes) {
        test::write_bytes(file, bytes);
        return refusal({file});
    };
    const std::string name = file.string();
    const std::string either = "; allowed: journal segments, or miniSEED files of a data root";
    CHECK(refusal({file}) == name + ": no such file" + either);
    CHECK(with({}) == name + ": empty" + either);
    CHECK(with(test::bytes_of("no journal")).starts_with(name + ": begins with no record"));
    CHECK(with(test::bytes_of("A351JRNL")) ==
          name + ": shorter than its preamble; allowed: journal segments with a whole header");
    auto newer = good_segment();
    newer[8] = std::byte{2};
    CHECK(with(newer).starts_with(name + ": not a journal of this version"));
    CHECK(with(segment_of({test::journal_header()})).starts_with(name + ": no byte was received"));
    auto torn = good_segment();
    torn.resize(100);
    CHECK(with(torn).starts_with(name + ": torn chunk; "));

    auto header = test::journal_header();
    header.profile = "A999";
    CHECK(with(segment_of({header})) ==
          name + ": profile A999: unknown; allowed: " + text::joined(wire::profile_names()));
    for (int field = 0; field < 4; ++field) {
        header = test::journal_header();
        if (field == 0) header.output_rate_hz = 51;
        if (field == 1) header.filter = "k513_fc9";
        if (field == 2) header.burst_ctrl = 0x0003;
        if (field == 3) header.baud = 9600;
        CAPTURE(field);
        CHECK(with(segment_of({header})).find("settings that profile A351 does not have") !=
              std::string::npos);
    }
    CHECK(with(good_segment()) == "accepted");

    // Journal segments and other files cannot be mixed.
    const fs::path other = directory.write("b", "000001D ");
    CHECK(refusal({file, other}).starts_with(other.string() + ": not a journal segment, "));
}

TEST_CASE("a directory is replayed as its segments in the order of their numbers") {
    const test::TemporaryDirectory directory;
    CHECK(refusal({directory.path()}) ==
          directory.path().string() +
              ": neither journal segments nor day files in it; allowed: journal segments, or "
              "miniSEED files of a data root");
    test::write_bytes(directory.path() / "00000012_x.a351j", good_segment(12));
    test::write_bytes(directory.path() / "00000003_y.a351j", good_segment(3));
    test::write_bytes(directory.path() / "notes.txt", test::bytes_of("not of it"));
    CHECK(open_recording({.files = {directory.path()}})->unit().identity.firmware == 3);
    CHECK(open_recording({.files = {directory.path() / "00000012_x.a351j",
                                    directory.path() / "00000003_y.a351j"}})
              ->unit()
              .identity.firmware == 3);
}

TEST_CASE("in a directory, segments without a header are skipped and reported") {
    const test::TemporaryDirectory directory;
    auto torn = good_segment();
    torn.resize(60);
    const fs::path empty_file = directory.path() / "00000002_x.a351j";
    const fs::path torn_file = directory.path() / "00000003_x.a351j";
    test::write_bytes(empty_file, {});
    test::write_bytes(torn_file, torn);
    CHECK(refusal({directory.path()})
              .starts_with(directory.path().string() +
                           ": no journal segment in it has a whole header"));
    test::write_bytes(directory.path() / "00000001_x.a351j", good_segment(7));
    const auto recording = open_recording({.files = {directory.path()}});
    CHECK(recording->unit().identity.firmware == 7);
    REQUIRE(recording->damage().size() == 2);
    CHECK(recording->damage()[0].file == empty_file);
    CHECK(recording->damage()[0].byte_count == 0);
    CHECK(recording->damage()[0].reason == "shorter than its preamble");
    CHECK(recording->damage()[1].file == torn_file);
    CHECK(recording->damage()[1].byte_count == 60);
    CHECK(recording->damage()[1].reason == "torn chunk");
    // A file without a header is an error if it is named itself.
    CHECK(refusal({directory.path() / "00000001_x.a351j", empty_file})
              .starts_with(empty_file.string() + ": empty"));
}

}  // namespace a351::sim::replay
