#pragma once
/// @file
/// Last check of the times before records reach the archive.

#include "protocol/archive/archiver.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::archive {

/// Keeps records with impossible times out of the archive: those of a host that started without a
/// clock.  Their data remain in the journal and can be re-timed if the host's clock was set later.
///
/// Archiver puts it between itself and its sink.  Samples pass in any case; only records are
/// withheld and counted in records_withheld.
class TimeGate final : public Sink {
public:
    /// Earliest plausible record: before the published survey with this sensor, of 2017.  A host
    /// without a clock starts in 1970.
    static constexpr UtcTime kEarliest =
        std::chrono::sys_days(std::chrono::year(2015) / std::chrono::January / 1);

    /// Latest one: what the journal can hold.  Reason: readers refuse records of later centuries.
    static constexpr UtcTime kLatest{journal::kLatestInstant};

    /// Sets the archive and the counters; both must outlive this.
    TimeGate(Sink& sink, Counters& counters) : sink_(sink), counters_(counters) {}

    /// Passes a record that begins between kEarliest and kLatest; counts any other.
    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override {
        if (record.start >= kEarliest && record.start <= kLatest)
            sink_.record(channel, record, last_index);
        else
            ++counters_.records_withheld;
    }
    void sample(const Sample& sample) override { sink_.sample(sample); }
    [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                UtcTime start) const override {
        return sink_.samples_in_archive(channel, start);
    }

private:
    Sink& sink_;
    Counters& counters_;
};

}  // namespace a351::archive
