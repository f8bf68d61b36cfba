#include "daemon/ctl/take_home.hpp"

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include "daemon/bundle/bundle.hpp"
#include "daemon/bundle/bundle_check.hpp"
#include "daemon/page/download_stream.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/served.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351;
using namespace a351::daemon;
using daemon::page::Download;

namespace {

/// Returns a bundle of 600 kB.
Download day() {
    const auto bundle = std::make_shared<bundle::Bundle>(
        bundle::Contents{.folder = "day",
                         .root = "/nonexistent",
                         .from = {},
                         .texts = {{"sites.csv", "site\n"}, {"log", std::string(600'000, 'x')}}});
    return {"day.tar", [bundle] { return bundle->open(); }, [bundle] { return bundle->next(); }};
}

/// Returns the begin of a tar file with this folder.
std::string copy_of(const std::string& folder) {
    std::string header(512, '\0');
    header.replace(0, folder.size() + 5, folder + "/file");
    return header.replace(257, 5, "ustar");
}

/// A folder with an older copy, and a server.
struct Stick {
    Stick() { served.bundle = day; }

    std::string take(files::FileLayer& files, const std::filesystem::path& to) {
        const ctl::Client client({"127.0.0.1", std::to_string(served.server.port())});
        return ctl::take_home(client, files, to);
    }
    /// Takes the day home, which fails.  @return the sentence
    std::string failure(files::FileLayer& files) {
        try {
            static_cast<void>(take(files, out));
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "no failure";
    }
    [[nodiscard]] bool has_only_the_older_copy() const {
        const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
        return entries == 1 && text::read_text_file(out) == copy_of("day");
    }

    test::TemporaryDirectory folder;
    std::filesystem::path out = folder.write("home.tar", copy_of("day"));
    Served served;
};

/// Files that change a byte on the way to the disk.
class ChangingFiles : public test::ForwardingFiles {
    struct File : test::ForwardingFile {
        using ForwardingFile::ForwardingFile;
        void append(std::span<const std::byte> bytes) override {
            std::vector<std::byte> changed(bytes.begin(), bytes.end());
            changed.back() ^= std::byte{1};
            file_->append(changed);
        }
    };

public:
    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        return std::make_unique<File>(ForwardingFiles::open_append(file));
    }
};

}  // namespace

TEST_CASE("the day replaces an older copy, or gets its own name in a folder") {
    Stick stick;
    const std::string line = stick.take(files::posix_files(), stick.out);
    CHECK(line.starts_with(stick.out.string() + ": 0.6 MB, 3 files, "));
    CHECK(bundle::check_bundle(stick.out) == 3);
    static_cast<void>(stick.take(files::posix_files(), stick.folder.path()));
    CHECK(text::read_text_file(stick.folder.path() / "day.tar") == text::read_text_file(stick.out));
    CHECK_THROWS_WITH(stick.take(files::posix_files(), "/dev/null"),
                      "/dev/null is not a file; nothing was saved");
    const std::string now = "XX_A351_20260302T003456Z";
    stick.served.bundle = [now] {
        Download download = day();
        download.name = now + ".tar";
        return download;
    };
    for (const std::string& same : {copy_of(now), copy_of("XX_A351_20260301T183457Z")})
        static_cast<void>(stick.take(files::posix_files(), stick.folder.write("same.tar", same)));
    for (const std::string& other : {std::string("a thesis"), copy_of("XX_A351_20260301T183456Z"),
                                     copy_of("XX_B_20260301T233456Z")}) {
        Stick another;
        another.served.bundle = stick.served.bundle;
        const auto file = another.folder.write("other.tar", other);
        CHECK_THROWS_WITH(another.take(files::posix_files(), file),
                          ContainsSubstring("exists and is no copy of the last hours"));
        CHECK(text::read_text_file(file) == other);
    }
}

TEST_CASE(
    "whichever operation of the disk fails, the older copy stays or the new one is complete") {
    int saved = 0;
    for (int n = 1;; ++n) {
        Stick stick;
        test::FailingFiles files(n);
        CAPTURE(n);
        const std::string failure = stick.failure(files);
        if (failure == "no failure") {
            CHECK(n > 5);
            break;
        }
        CAPTURE(failure);
        if (stick.has_only_the_older_copy()) {
            CHECK(failure.ends_with("; nothing was saved"));
        } else {
            ++saved;
            CHECK(bundle::check_bundle(stick.out) == 3);
            CHECK(failure.find("is complete and compared") != std::string::npos);
        }
    }
    CHECK(saved == 1);  // The last sync of the folder.
}

TEST_CASE("a full disk is said with what the copy needs") {
    Stick stick;
    test::FailingFiles files;
    files.set({1, test::Fault::Kind::full_disk});
    CHECK(stick.failure(files) == "the disk of " + stick.folder.path().string() +
                                      " is full, the copy needs 0.6 MB; nothing was saved");
    CHECK(stick.has_only_the_older_copy());
}

TEST_CASE("a disk that changes a byte is found by reading back") {
    Stick stick;
    ChangingFiles files;
    CHECK_THAT(stick.failure(files), EndsWith("; nothing was saved, try another disk"));
    CHECK(stick.has_only_the_older_copy());
}

TEST_CASE("a day that the daemon cannot read to its end is not saved") {
    Stick stick;
    stick.served.bundle = [] {
        Download download = day();
        download.next = [next = download.next, piece = 0]() mutable {
            if (piece++ > 0) throw std::runtime_error("the disk fails");
            return next();
        };
        return download;
    };
    CHECK_THAT(stick.failure(files::posix_files()),
               StartsWith("the daemon ended the transfer after 0.3 of 0.6 MB"));
    CHECK(stick.has_only_the_older_copy());
    stick.served.bundle = [] {
        Download download = day();
        download.open = []() -> std::uint64_t { throw std::runtime_error("sites.csv is gone"); };
        return download;
    };
    CHECK(stick.failure(files::posix_files()) == "sites.csv is gone");
    CHECK(stick.has_only_the_older_copy());
    CHECK(stick.served.is_well());
}

TEST_CASE("two copies are made at a time, a third one is refused, and they end with the server") {
    std::promise<void> go;
    const std::shared_future<void> gone = go.get_future().share();
    std::atomic<int> begun = 0;
    Served served;
    served.bundle = [gone, &begun] {
        ++begun;
        Download download = day();
        download.open = [open = download.open, gone] {
            gone.wait();
            return open();
        };
        return download;
    };
    const RawClient first(served.server.port()), second(served.server.port());
    first.send(served.get("/api/bundle"));
    second.send(served.get("/api/bundle"));
    while (begun < 2) std::this_thread::yield();
    CHECK(status_of(served.answer(served.get("/api/bundle"))) == 503);
    CHECK(served.is_well());
    go.set_value();
    for (const RawClient* client : {&first, &second}) {
        const std::string answer = client->rest();
        CHECK(status_of(answer) == 200);
        CHECK(answer.find("filename=\"day.tar\"") != std::string::npos);
        CHECK(answer.size() > 600'000);
    }
    CHECK(status_of(served.answer("HEAD /api/bundle HTTP/1.1\r\n" + served.host() + "\r\n")) ==
          405);
    const RawClient last(served.server.port());
    last.send(served.get("/api/bundle"));
}
