// Joins the records of an archive with libmseed's own rules and prints one line about the traces:
// `channel=C traces=N samples=N records=N recorded=N end_error_s=S`.
// `recorded` is the number of samples in the records.  `end_error_s` is the time of the last sample
// of the last trace, computed from the trace's start and rate, minus the time in the newest record.
//   mseed-traces ARCHIVE CHANNEL

#include <libmseed.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: mseed-traces ARCHIVE CHANNEL\n");
        return 2;
    }
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[1]))
        if (entry.is_regular_file() &&
            entry.path().filename().string().find(argv[2]) != std::string::npos)
            files.insert(entry.path());
    MSTraceList* traces = mstl_init(nullptr);
    std::int64_t recorded = 0, records = 0;
    hptime_t last = 0;
    for (const auto& file : files) {
        MSRecord* record = nullptr;
        int code = MS_NOERROR;
        while ((code = ms_readmsr(&record, file.c_str(), 0, nullptr, nullptr, 1, 0, 0)) ==
               MS_NOERROR) {
            recorded += record->samplecnt;
            ++records;
            last = msr_endtime(record);
            if (!mstl_addmsr(traces, record, 0, 1, -1.0, -1.0)) return 1;
        }
        ms_readmsr(&record, nullptr, 0, nullptr, nullptr, 0, 0, 0);
        if (code != MS_ENDOFFILE) {
            std::fprintf(stderr, "%s: %s\n", file.c_str(), ms_errorstr(code));
            return 1;
        }
    }
    std::int64_t samples = 0;
    std::int64_t segments = 0;
    double end_error_s = 0.0;
    for (const MSTraceID* id = traces->traces; id != nullptr; id = id->next) {
        for (const MSTraceSeg* segment = id->first; segment != nullptr; segment = segment->next) {
            ++segments;
            samples += segment->samplecnt;
            const double span_s = static_cast<double>(segment->samplecnt - 1) / segment->samprate;
            const double true_span_s = static_cast<double>(last - segment->starttime) / HPTMODULUS;
            end_error_s = span_s - true_span_s;
        }
    }
    std::printf("channel=%s traces=%lld samples=%lld records=%lld recorded=%lld end_error_s=%.6f\n",
                argv[2], static_cast<long long>(segments), static_cast<long long>(samples),
                static_cast<long long>(records), static_cast<long long>(recorded), end_error_s);
    mstl_free(&traces, 0);
}
