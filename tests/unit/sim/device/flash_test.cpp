#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"
#include "sim/device/flash_memory.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

namespace {

const MachineIdentity kIdentity{"A352AD10", "01234567", 0x000D};

const wire::DeviceProfile& profile() { return *wire::find_profile("A352AD10"); }

void back_up(Bench& bench) {
    bench.send({"FE 01", "8A 08"});
    bench.wait(RegisterMachine::kFlashBackupTime);
}

/// Returns the first coefficient that the host reads.
std::string first_coefficient(Bench& bench) {
    bench.send({"FE 01", "9B 08", "9A 00", "96 01"});
    return bench.read("W1:18");
}

}  // namespace

TEST_CASE("FLASH_BACKUP reads 1 for 310 ms, and then the settings survive power cycle and reset") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "89 03", "8D C7", "C7 05", "9E 03", "83 40", "8A 08"});
    CHECK(bench.read("W1:0A") == "0008");
    bench.wait(RegisterMachine::kFlashBackupTime);
    CHECK(bench.read("W1:0A") == "0000");
    CHECK(bench.read("W0:04") == "0000");
    bench.write("W1:85 05");  // Not backed up.
    for (const bool by_reset : {false, true}) {
        by_reset ? bench.reset() : bench.power_cycle();
        CHECK(bench.read("W1:02") == "0026");  // Without the self test that ran.
        CHECK(bench.read("W1:04") == "0600");
        CHECK(bench.read("W1:06") == "0006");  // Without the busy bit.
        CHECK(bench.machine.baud() == 115200);
        CHECK(bench.read("W1:0C") == "C702");
        CHECK(bench.read("W1:46") == "05F1");
        CHECK(bench.read("W1:1E") == "0003");
    }
    bench.write("W1:86 08");  // This filter does not fit the rate.
    back_up(bench);
    bench.power_cycle();
    CHECK(bench.read("W0:06") == "0002");
    bench.write("W1:86 06");
    CHECK(bench.read("W0:06") == "0000");
}

TEST_CASE("a power failure during a backup leaves the flash as it was") {
    Bench bench;
    bench.send({"FE 01", "85 06", "8A 08"});
    bench.wait(RegisterMachine::kFlashBackupTime - 2ms);
    bench.power_cycle();
    CHECK(bench.read("W1:04") == "0400");
    CHECK(bench.machine.flash() == FlashMemory{});
}

TEST_CASE("FLASH_RST takes 1.9 s and has its effect only after the next reset") {
    Bench bench;
    bench.write("W1:85 06");
    back_up(bench);
    bench.send({"FE 01", "8A 04"});
    CHECK(bench.read("W1:0A") == "0004");
    bench.wait(RegisterMachine::kFlashResetTime - 5ms);
    CHECK(bench.read("W1:0A") == "0004");
    CHECK(bench.read("W1:0A") == "0000");
    CHECK(bench.read("W1:04") == "0600");
    bench.power_cycle();
    CHECK(bench.read("W1:04") == "0400");
}

TEST_CASE("a failed backup is reported in FLASH_BU_ERR") {
    Bench bench;
    bench.machine.fail_tests(0x0001);
    bench.write("W1:85 06");
    back_up(bench);
    CHECK(bench.read("W0:04") == "0001");
    Bench full;
    full.machine.on_flash_written([](const FlashMemory&) { return false; });
    back_up(full);
    CHECK(full.read("W0:04") == "0001");
}

TEST_CASE("coefficients are lost at a power cycle unless their filter was selected") {
    for (const bool is_selected : {false, true}) {
        CAPTURE(is_selected);
        std::optional<FlashMemory> kept;
        int stores = 0;
        Bench bench;
        bench.machine.on_flash_written([&](const FlashMemory& memory) {
            kept = memory;
            return ++stores > 0;
        });
        bench.send({"FE 01", "98 55", "96 02"});
        bench.wait(UserFilter::kWriteTime);
        if (is_selected) bench.send({"86 0B", "86 0C"});  // Written once.
        CHECK(first_coefficient(bench) == "0055");
        CHECK(bench.machine.flash() == kept.value_or(FlashMemory{}));
        const std::string expected = is_selected ? "0055" : "00FF";
        bench.power_cycle();
        CHECK(first_coefficient(bench) == expected);
        Bench next_run("A352AD10", kIdentity, kept.value_or(FlashMemory{}));
        CHECK(first_coefficient(next_run) == expected);
        CHECK(stores == (is_selected ? 1 : 0));
    }
}

TEST_CASE("a power cycle writes nothing to the flash, and the user filter in it is active") {
    FlashMemory flash;
    flash.coefficients.fill(0);
    flash.coefficients[3] = 0x40;  // One coefficient of 0.5.
    Bench bench("A352AD10", kIdentity, flash);
    int stores = 0;
    bench.machine.on_flash_written([&stores](const FlashMemory&) { return ++stores > 0; });
    bench.send({"FE 01", "85 06", "86 0B", "88 01", "8C 00", "8D 01"});
    back_up(bench);
    REQUIRE(stores == 1);
    bench.send({"FE 01", "98 55", "96 02"});
    bench.wait(UserFilter::kWriteTime);
    bench.power_cycle();
    CHECK(stores == 1);
    Bench next_run("A352AD10", kIdentity, bench.machine.flash());
    for (Bench* started : {&bench, &next_run}) {
        started->send({"83 01"});
        CHECK(started->sample(1, {{0, 0, 2 * kOneG}, 0}) == "80 01 00 00 00 0D");
    }
}

TEST_CASE("any content of the flash can be written to a file and read back") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "any";
    FlashMemory memory;
    for (std::size_t i = 0; i < memory.coefficients.size(); ++i) {
        memory.coefficients[i] = static_cast<std::uint8_t>(i * 7);
    }
    memory.settings.back() = 0x0AF6;
    for (const FlashMemory& content : {memory, FlashMemory{}}) {
        write_flash_file(file, content);
        CHECK(read_flash_file(file, profile()) == content);
    }
}

TEST_CASE("a damaged flash file is refused in one line that names the file and the key") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "damaged";
    write_flash_file(file, FlashMemory{});
    const std::string good = text::read_text_file(file);
    const auto changed = [](std::string text, std::string_view from, std::string_view to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const auto replaced = [&](std::string_view from, std::string_view to) {
        return changed(good, from, to);
    };
    // The long-term filter and 1000 samples a second exclude each other.
    const std::string filtered = replaced("LONGFILT_CTRL = 0x0000", "LONGFILT_CTRL = 0x0001");
    const std::pair<std::string, std::string> kDamaged[] = {
        {changed(filtered, "SMPL_CTRL = 0x0400", "SMPL_CTRL = 0x0200"),
         ":11: registers.LONGFILT_CTRL = 0x1"},
        {good.substr(0, good.find("\nZALARM")), "ZALARM"},
        {good.substr(0, good.find("= 0x") + 4), "not TOML"},
        {"", "format"},
        {replaced("format = 1", "format = 2"), "format"},
        {replaced("SMPL_CTRL = 0x0400", "SMPL_CTRL = 0x0900"), "SMPL_CTRL"},
        {replaced("FILTER_CTRL = 0x0008", "FILTER_CTRL = 0x0028"), "FILTER_CTRL"},
        {replaced("UART_CTRL = 0x0100", "UART_CTRL = 0x0000"), "UART_CTRL"},
        {replaced("MSC_CTRL = 0x0026", "MSC_CTRL = 0x0126"), "MSC_CTRL"},
        {replaced("LONGFILT_TAP = 0x000A", "LONGFILT_TAP = 0x000F"), "LONGFILT_TAP"},
        {replaced("SIG_CTRL = 0x8E04", "SIG_CTRL = 0x18E04"), "SIG_CTRL"},
        {replaced("SIG_CTRL = 0x8E04", "SIG_CTRL = \"8E04\""), "SIG_CTRL"},
        {replaced("XALARM", "WALARM"), "XALARM"},
        {replaced("ZALARM = 0x0FF1\n", "ZALARM = 0x0FF1\nWALARM = 0\n"), "WALARM"},
        {replaced("bytes = []", "bytes = [\"0G\"]"), "bytes"},
        {replaced("bytes = []", "bytes = [\"000\"]"), "bytes"},
        {replaced("bytes = []", "bytes = [\"" + std::string(4098, '0') + "\"]"), "bytes"},
    };
    test::write_bytes(file, test::bytes_of(filtered));
    CHECK_NOTHROW(read_flash_file(file, profile()));
    for (const auto& [text, named] : kDamaged) {
        CAPTURE(text.substr(0, 80), named);
        test::write_bytes(file, test::bytes_of(text));
        try {
            static_cast<void>(read_flash_file(file, profile()));
            FAIL("accepted");
        } catch (const InputError& error) {
            CHECK_THAT(error.what(),
                       ContainsSubstring(file.filename().string()) && ContainsSubstring(named));
            CHECK_THAT(error.what(), !ContainsSubstring("\n"));
        }
    }
}
