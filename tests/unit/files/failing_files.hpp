#pragma once

#include <atomic>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "tests/unit/files/forwarding_files.hpp"

namespace a351::test {

/// Fault of the n-th operation of a kind.
struct Fault {
    enum class Kind {
        any,          ///< EIO; an append leaves its first half on disk.
        full_disk,    ///< ENOSPC if the operation takes space; an append leaves nothing on disk.
        short_write,  ///< ENOSPC for an append, which leaves its first half on disk.
        sync,         ///< EIO for a sync; unsynced bytes become zeros, like dropped pages.
    };
    int at = 0;  ///< Number of the operation, from 1; 0: none.
    Kind kind = Kind::any;
    bool lasts = false;  ///< All later operations of the kind fail too.
};

/// The real files, of which one operation, or all from one on, fail. Nothing is synced to the
/// medium, because no test reads it there and thousands of syncs take minutes. Any number of
/// threads may use an object.
class FailingFiles : public ForwardingFiles {
public:
    explicit FailingFiles(int fail_at = 0) { fault_.at = fail_at; }

    /// Returns the number of operations of the fault's kind so far.
    [[nodiscard]] int operations() const noexcept { return operations_; }
    void fail_at(int n) noexcept { fault_.at = n; }
    /// Sets the fault and counts from zero again. Call it before other threads use the files.
    void set(const Fault& fault) noexcept {
        fault_.kind = fault.kind;
        fault_.lasts = fault.lasts;
        fault_.at = fault.at;
        operations_ = 0;
    }

    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override {
        count(Operation::takes_space);
        return std::make_unique<File>(*this, file, files_.open_append(file));
    }
    void create_directories(const std::filesystem::path& directory) override {
        count(Operation::takes_space);
        std::filesystem::create_directories(directory);
    }
    void sync_directory(const std::filesystem::path&) override { count(Operation::other); }
    void truncate(const std::filesystem::path& file, std::uint64_t size) override {
        count(Operation::other);
        std::filesystem::resize_file(file, size);
    }
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        count(Operation::other);
        files_.rename(from, to);
    }
    void remove(const std::filesystem::path& file) override {
        count(Operation::other);
        files_.remove(file);
    }
    void allocate(const std::filesystem::path& file, std::uint64_t size) override {
        count(Operation::takes_space);
        std::ofstream(file, std::ios::app).close();
        std::filesystem::resize_file(file, size);
    }

private:
    enum class Operation { append, sync, takes_space, other };

    class File : public ForwardingFile {
    public:
        File(FailingFiles& files, std::filesystem::path path,
             std::unique_ptr<files::AppendFile> file)
            : ForwardingFile(std::move(file)), files_(files), path_(std::move(path)) {}
        void append(std::span<const std::byte> bytes) override {
            try {
                files_.count(Operation::append);
            } catch (...) {
                if (files_.fault_.kind != Fault::Kind::full_disk) {
                    file_->append(bytes.first(bytes.size() / 2));
                }
                throw;
            }
            file_->append(bytes);
        }
        void sync() override {
            try {
                files_.count(Operation::sync);
            } catch (...) {
                if (files_.fault_.kind == Fault::Kind::sync) drop_unsynced();
                throw;
            }
            synced_ = size();
        }

    private:
        void drop_unsynced() const {
            std::fstream out(path_, std::ios::binary | std::ios::in | std::ios::out);
            out.seekp(static_cast<std::streamoff>(synced_));
            for (std::uint64_t i = synced_; i < size(); ++i) out.put('\0');
        }

        FailingFiles& files_;
        std::filesystem::path path_;
        std::uint64_t synced_ = file_->size();
    };

    /// Returns true if the fault applies to the operation. Making and syncing directories and files
    /// takes blocks that a full disk lacks; removing takes none.
    [[nodiscard]] bool is_of_kind(Operation operation) const noexcept {
        switch (fault_.kind) {
            case Fault::Kind::any:
                return true;
            case Fault::Kind::full_disk:
                return operation != Operation::other;
            case Fault::Kind::short_write:
                return operation == Operation::append;
            case Fault::Kind::sync:
                return operation == Operation::sync;
        }
        return false;
    }

    void count(Operation operation) {
        if (!is_of_kind(operation)) return;
        const int n = ++operations_;
        const int at = fault_.at;
        if (n != at && !(fault_.lasts && at > 0 && n > at)) return;
        const bool is_io = fault_.kind == Fault::Kind::any || fault_.kind == Fault::Kind::sync;
        throw std::system_error(is_io ? EIO : ENOSPC, std::generic_category(),
                                "operation made to fail");
    }

    struct {
        std::atomic<int> at = 0;
        Fault::Kind kind = Fault::Kind::any;
        bool lasts = false;
    } fault_;
    std::atomic<int> operations_ = 0;
};

}  // namespace a351::test
