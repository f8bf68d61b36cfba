#pragma once
/// @file
/// The archive of a data root again, with times computed afterwards.
///
/// Use it after a recording for the best times, if the host's clock was wrong during the recording,
/// or if the profile was wrong.  retime() does all; Retiming is its connection to the archiver.
///
///     const RetimeReport report = retime(posix_files(), "/data/box1", "/data/box1-retimed");
///     for (const journal::Damage& damage : report.damage) warn(damage.reason);

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/timing/hindsight.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::archive {

/// Two passes of an archiver over a journal: the first one collects the data from which the times
/// of the second one are computed.
///
/// Collects the runs of the sensor in order, and clock readings per boot of the host; one boot may
/// have several runs.
///
///     Retiming retiming;
///     { Archiver first(nothing, &retiming);  ... }    // pass 1: all chunks; records are dropped
///     retiming.begin_second_pass();
///     { Archiver second(archives, &retiming);  ... }  // pass 2: the same chunks
///
/// The archiver calls begin_run(), observe_clock() and observe().  The latter two do nothing in the
/// second pass.
///
/// Memory: one small entry per 2 s of data and per clock reading, and all times of the second pass.
class Retiming {
public:
    /// Begins a run, whose index starts at 0.  In the second pass `clock` gets the times of this
    /// run.
    /// @throws InputError  the second pass has more runs than the first: the journal grew.
    void begin_run(const journal::Header& header, timing::SampleClockOptions options,
                   timing::SampleClock& clock);
    /// Adds a clock reading of the host on which the newest run was recorded.  Precondition:
    /// begin_run() was called.
    void observe_clock(const timing::ClockReading& reading);
    /// Adds the arrival of a sample of the newest run, on the raw clock as it was read.
    void observe(std::int64_t index, RawTime arrival);

    /// Begins the second pass: the same chunks follow again, from the first one.
    void begin_second_pass() { is_second_pass_ = true; }

    /// Returns the new time of a sample; to be called after the second pass.  If a session has
    /// several runs with this index, it is the time nearest to `near`.  std::nullopt for an unknown
    /// session.
    [[nodiscard]] std::optional<UtcTime> time_of(const journal::SessionId& session,
                                                 std::int64_t index, UtcTime near) const;

    /// Returns the runs during which the host's clock was never synchronised, from its start to its
    /// end.  Nothing corrects their times.
    [[nodiscard]] std::size_t unsynchronised_runs() const;

private:
    struct Run {
        journal::SessionId session;
        std::string boot_id;
        timing::Hindsight hindsight;
        std::optional<timing::SampleClock> clock;  ///< Clock of the second pass.
    };
    bool is_second_pass_ = false;
    std::map<std::string, timing::UtcHistory> histories_;
    std::vector<Run> runs_;
    std::size_t next_run_ = 0;
};

/// Returns the header that the daemon would have written with another profile.  The device has a
/// rate and a filter by their codes, so these are the ones of the codes.
/// @throws InputError  the header's profile is unknown, or `profile` lacks a code.
[[nodiscard]] journal::Header recorded_with(const wire::DeviceProfile& profile,
                                            journal::Header header);

/// A segment of the journal, and the new time of its first sample.
struct RetimedSegment {
    journal::Header header;        ///< With a given profile, the one of recorded_with().
    std::optional<UtcTime> start;  ///< Absent if it has no time.
};

/// Writes the folder `metadata` of a data root; `to` is the new root.
using MetadataWriter =
    std::function<void(const std::filesystem::path& from, const std::filesystem::path& to,
                       const std::vector<RetimedSegment>& segments)>;

/// Copies the folder `metadata`, if there is one.
void copy_metadata(const std::filesystem::path& from, const std::filesystem::path& to);

/// Result of retime().
struct RetimeReport {
    std::uint64_t segments = 0;           ///< Segments of the journal, damaged ones included.
    std::uint64_t records = 0;            ///< Records written.
    std::vector<journal::Damage> damage;  ///< Places of the journal whose chunks are lost.
    Counters counters;                    ///< Counters of the whole journal, read once.
    std::size_t unsynchronised_runs = 0;  ///< Retiming::unsynchronised_runs().
};

/// Writes the archive of a data root again, with times computed afterwards: each second from the
/// arrivals 450 s before and after it, and from the readings at which the host's clock was
/// synchronised.  Samples, gaps and channels are those of the running daemon; records may end at
/// other samples.  Events keep their samples and get the new times.  The journal is not copied.
///
/// The result is complete or absent: it is written beside `out` and renamed at the end.
///
/// Accuracy: that of timing::Hindsight.  On a made-up stream without delays, records are within 0.5
/// ms from the first sample after a sleep of the host on (retime_test.cpp).
///
/// Cost: the journal is read twice.  Deterministic: the same journal gives the same samples and
/// times.
/// @param root  data root with the folders journal, events and metadata; the last two may be
///              absent.  No daemon may write to it meanwhile.
/// @param out   new directory; `out` + ".partial" beside it must not exist either.
/// @param profile   if given, everything is as if it had been recorded with it: recorded_with().
/// @param metadata  writes the metadata; station::describe_again() gives their epochs the new times.
/// @throws InputError         no journal in `root`, or `out` exists, or a header of the journal
///                            names unknown settings, or settings that `profile` lacks.
/// @throws std::runtime_error no frame of the sensor can be read; nothing is written.
/// @throws std::system_error  a file cannot be read or written.
RetimeReport retime(
    files::FileLayer& files, const std::filesystem::path& root, const std::filesystem::path& out,
    const wire::DeviceProfile* profile = nullptr,
    const MetadataWriter& metadata = [](const auto& from, const auto& to, const auto&) {
        copy_metadata(from, to);
    });

}  // namespace a351::archive
