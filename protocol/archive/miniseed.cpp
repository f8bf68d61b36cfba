#include "protocol/archive/miniseed.hpp"

#include <libmseed.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "protocol/archive/miniseed_layout.hpp"

namespace a351::archive {

namespace {

// libmseed 2.19 refuses a Steim-2 difference of 2^29 and of -2^29.
constexpr std::int64_t kSteim2Limit = std::int64_t{1} << 29;
constexpr std::size_t kMostSamplesPerSteimWord = 7;

template <class Int>
Int get(std::span<const std::byte> bytes, std::size_t at) {
    std::make_unsigned_t<Int> bits = 0;
    for (std::size_t i = 0; i < sizeof(Int); ++i) {
        bits =
            static_cast<decltype(bits)>(bits << 8 | std::to_integer<std::uint8_t>(bytes[at + i]));
    }
    return static_cast<Int>(bits);
}

template <>
std::uint8_t get<std::uint8_t>(std::span<const std::byte> bytes, std::size_t at) {
    return std::to_integer<std::uint8_t>(bytes[at]);
}

float get_float(std::span<const std::byte> bytes, std::size_t at) {
    return std::bit_cast<float>(get<std::uint32_t>(bytes, at));
}

void put_float(std::span<std::byte> bytes, std::size_t at, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::byte(bits >> (24 - 8 * i) & 0xFFU);
}

void discard_message(char*) {}

/// Locks libmseed, which keeps its log and last error in process-wide variables.
std::unique_lock<std::mutex> lock_libmseed() {
    static std::mutex mutex;
    std::unique_lock lock(mutex);
    static const bool is_quiet = [] {
        ms_loginit(discard_message, nullptr, discard_message, nullptr);
        return true;
    }();
    static_cast<void>(is_quiet);
    return lock;
}

struct FreeRecord {
    void operator()(MSRecord* record) const noexcept { msr_free(&record); }
};

bool jumps(std::span<const std::int32_t> samples, std::size_t i) {
    const std::int64_t difference = std::int64_t{samples[i]} - samples[i - 1];
    return difference >= kSteim2Limit || difference <= -kSteim2Limit;
}

/// Samples of the next record, and their coding.
struct Portion {
    std::size_t sample_count = 0;
    bool is_integer_coded = false;
};

/// Chooses the samples up to the first jump, in Steim-2: the jump is then the first difference of
/// the next record, which is not used.  A jump directly after the first sample would give records
/// of one sample.  In this case all successive samples that are followed by a jump are coded as
/// integers.
Portion next_portion(std::span<const std::int32_t> samples) {
    const std::size_t limit = std::min(samples.size(), kMostSamplesPerRecord);
    std::size_t first_jump = 1;
    while (first_jump < limit && !jumps(samples, first_jump)) ++first_jump;
    if (first_jump > 1 || limit == 1) return {first_jump, false};
    std::size_t end = 1;
    while (end < limit && jumps(samples, end)) ++end;
    return {end == limit ? limit : end - 1, true};
}

template <std::size_t N>
void copy_code(char (&target)[N], const std::string& code) {
    std::copy_n(code.begin(), std::min(code.size(), N - 1), target);
}

template <class Blockette>
void add_blockette(MSRecord* record, Blockette blockette, int type) {
    constexpr int kAtEnd = 0;
    if (!msr_addblockette(record, reinterpret_cast<char*>(&blockette), sizeof blockette, type,
                          kAtEnd)) {
        throw std::bad_alloc();
    }
}

void set_flags(fsdh_s& fixed, const RecordHeader& header) {
    fixed.io_flags = static_cast<std::uint8_t>((header.is_clock_locked ? kClockLocked : 0) |
                                               (header.starts_series ? kStartOfSeries : 0) |
                                               (header.ends_series ? kEndOfSeries : 0));
    fixed.dq_flags =
        static_cast<std::uint8_t>((header.is_clipped ? kClipped : 0) |
                                  (header.had_transmission_errors ? kSynchronisationError : 0) |
                                  (header.is_time_questionable ? kTimeTagQuestionable : 0));
}

/// Keeps the first record only; further samples are packed again with the next record.
void keep_first_record(char* bytes, int length, void* target) {
    auto& record = *static_cast<PackedRecord*>(target);
    if (record.sample_count > 0 || length != static_cast<int>(kRecordSize)) return;
    std::memcpy(record.bytes.data(), bytes, kRecordSize);
    record.sample_count = get<std::uint16_t>(record.bytes, kSampleCountAt);
}

bool is_text_of(std::span<const std::byte> bytes, std::size_t at, std::size_t length,
                bool (*is_allowed)(char)) {
    return std::ranges::all_of(bytes.subspan(at, length), [&](std::byte byte) {
        return is_allowed(std::to_integer<char>(byte));
    });
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_code_character(char c) { return is_digit(c) || (c >= 'A' && c <= 'Z') || c == ' '; }

bool is_start_time(std::span<const std::byte> bytes) {
    const auto year = get<std::uint16_t>(bytes, kYearAt);
    const auto day = get<std::uint16_t>(bytes, kDayOfYearAt);
    const bool is_leap = std::chrono::year(year).is_leap();
    const auto microseconds = get<std::int8_t>(bytes, kBlockette1001At + 5);
    const auto hour = get<std::uint8_t>(bytes, kHourAt);
    const auto minute = get<std::uint8_t>(bytes, kHourAt + 1);
    const auto second = get<std::uint8_t>(bytes, kHourAt + 2);
    return year >= 1900 && year <= 2200 && day >= 1 && day <= (is_leap ? 366 : 365) && hour < 24 &&
           minute < 60 &&
           // Other recorders write 23:59:60 in a leap second; the sample is then at midnight.
           second < (hour == 23 && minute == 59 ? 61 : 60) &&
           get<std::uint16_t>(bytes, kFractionAt) < 10'000 && microseconds >= -50 &&
           microseconds < 50;
}

bool is_blockette(std::span<const std::byte> bytes, std::size_t at, int type, std::size_t next) {
    return get<std::uint16_t>(bytes, at) == type && get<std::uint16_t>(bytes, at + 2) == next;
}

/// Returns true for a whole number of Hz, or for minus the seconds from sample to sample.
bool is_rate(int factor, int multiplier) {
    return factor > 0 ? multiplier == 1 : factor < -1 && multiplier == -1;
}

/// Returns the rate of the fixed header; is_rate() must be true for it.
double nominal_rate_hz(std::span<const std::byte> bytes) {
    const double factor = get<std::int16_t>(bytes, kRateFactorAt);
    return factor > 0.0 ? factor : -1.0 / factor;
}

/// Returns true if a declared rate is near the nominal one, which it corrects by some ppm.  Any
/// other is damage, and could give times that overflow an integer.
bool is_declared_rate(double rate_hz, double nominal_hz) {
    constexpr double kFarthest = 0.1;
    return std::abs(rate_hz / nominal_hz - 1.0) <= kFarthest;
}

/// Returns true if every field that determines the shape of the record is as pack_record() writes
/// it.  libmseed uses offsets and counts without checking all of them, so damage must be found
/// here.
bool is_layout_ours(std::span<const std::byte> bytes) {
    const std::size_t blockettes = get<std::uint8_t>(bytes, kBlocketteCountAt);
    if (blockettes != 2 && blockettes != 3) return false;
    const bool has_rate = blockettes == 3;
    const auto coding = get<std::uint8_t>(bytes, kBlockette1000At + 4);
    const std::size_t header_end = has_rate ? kBlockette100End : kBlockette100At;
    const std::size_t data_at = coding == kCodingInt32 ? header_end
                                : has_rate             ? 2 * kSteimFrameSize
                                                       : kSteimFrameSize;
    const std::size_t words = (kRecordSize - data_at) / 4;
    const std::size_t most_samples =
        coding == kCodingInt32 ? words : (words - words / 16 - 2) * kMostSamplesPerSteimWord;
    const auto sample_count = get<std::uint16_t>(bytes, kSampleCountAt);
    return is_text_of(bytes, kSequenceAt, 6, is_digit) &&
           get<std::uint16_t>(bytes, kQualityAt) == ('D' << 8 | ' ') &&
           is_text_of(bytes, kStationAt, kYearAt - kStationAt, is_code_character) &&
           is_start_time(bytes) && sample_count >= 1 && sample_count <= most_samples &&
           is_rate(get<std::int16_t>(bytes, kRateFactorAt),
                   get<std::int16_t>(bytes, kRateMultiplierAt)) &&
           get<std::uint8_t>(bytes, kActivityFlagsAt) == 0 &&
           get<std::int32_t>(bytes, kCorrectionAt) == 0 &&
           get<std::uint16_t>(bytes, kDataOffsetAt) == data_at &&
           get<std::uint16_t>(bytes, kFirstBlocketteAt) == kBlockette1000At &&
           is_blockette(bytes, kBlockette1000At, 1000, kBlockette1001At) &&
           (coding == kCodingInt32 || coding == kCodingSteim2) &&
           get<std::uint8_t>(bytes, kBlockette1000At + 5) == kBigEndian &&
           get<std::uint8_t>(bytes, kBlockette1000At + 6) == kLog2RecordSize &&
           is_blockette(bytes, kBlockette1001At, 1001, has_rate ? kBlockette100At : 0) &&
           get<std::uint8_t>(bytes, kBlockette1001At + 4) <= 100 &&
           (!has_rate ||
            (is_blockette(bytes, kBlockette100At, 100, 0) &&
             is_declared_rate(static_cast<double>(get_float(bytes, kBlockette100At + 4)),
                              nominal_rate_hz(bytes))));
}

/// Compares the samples with the first and the last one that Steim coding stores beside the
/// differences.  libmseed only warns if the last one disagrees.
bool do_steim_ends_agree(std::span<const std::byte> bytes, std::span<const std::int32_t> samples) {
    if (get<std::uint8_t>(bytes, kBlockette1000At + 4) != kCodingSteim2) return true;
    const std::size_t data_at = get<std::uint16_t>(bytes, kDataOffsetAt);
    return samples.front() == get<std::int32_t>(bytes, data_at + 4) &&
           samples.back() == get<std::int32_t>(bytes, data_at + 8);
}

RecordHeader header_of(std::span<const std::byte> bytes, const MSRecord& record) {
    RecordHeader header;
    header.network = record.network;
    header.station = record.station;
    header.location = record.location;
    header.channel = record.channel;
    header.sequence = record.sequence_number;
    header.start = UtcTime(std::chrono::microseconds(record.starttime));
    header.nominal_rate = Hertz(nominal_rate_hz(bytes));
    if (record.Blkt100) header.declared_rate_hz = get_float(bytes, kBlockette100At + 4);
    const auto io = get<std::uint8_t>(bytes, kClockFlagsAt);
    const auto quality = get<std::uint8_t>(bytes, kQualityFlagsAt);
    header.is_clock_locked = io & kClockLocked;
    header.starts_series = io & kStartOfSeries;
    header.ends_series = io & kEndOfSeries;
    header.is_clipped = quality & kClipped;
    header.had_transmission_errors = quality & kSynchronisationError;
    header.is_time_questionable = quality & kTimeTagQuestionable;
    header.timing_quality_percent = get<std::uint8_t>(bytes, kBlockette1001At + 4);
    return header;
}

}  // namespace

PackedRecord pack_record(const RecordHeader& header, std::span<const std::int32_t> samples) {
    if (samples.empty()) throw std::invalid_argument("pack_record: no samples");
    if (header.sequence < 1 || header.sequence > kLargestSequence)
        throw std::invalid_argument("pack_record: sequence outside 1 ... 999999");
    const auto lock = lock_libmseed();
    const std::unique_ptr<MSRecord, FreeRecord> record(msr_init(nullptr));
    if (!record) throw std::bad_alloc();
    record->fsdh = static_cast<fsdh_s*>(std::calloc(1, sizeof(fsdh_s)));  // msr_free() frees it.
    if (!record->fsdh) throw std::bad_alloc();
    set_flags(*record->fsdh, header);
    record->reclen = static_cast<int>(kRecordSize);
    record->sequence_number = header.sequence;
    record->dataquality = 'D';
    copy_code(record->network, header.network);
    copy_code(record->station, header.station);
    copy_code(record->location, header.location);
    copy_code(record->channel, header.channel);
    record->starttime =
        std::chrono::round<std::chrono::microseconds>(header.start.time_since_epoch()).count();
    record->samprate = header.nominal_rate.value();
    record->byteorder = 1;
    record->sampletype = 'i';
    // libmseed appends 1000 after all others unless it is already the first.
    add_blockette(record.get(), blkt_1000_s{}, 1000);
    blkt_1001_s timing{};
    timing.timing_qual =
        static_cast<std::uint8_t>(std::clamp(header.timing_quality_percent, 0, 100));
    add_blockette(record.get(), timing, 1001);
    if (header.declared_rate_hz) add_blockette(record.get(), blkt_100_s{}, 100);

    Portion portion = next_portion(samples);
    if (portion.is_integer_coded) {
        const std::size_t data_at = header.declared_rate_hz ? kBlockette100End : kBlockette100At;
        portion.sample_count = std::min(portion.sample_count, (kRecordSize - data_at) / 4);
    }
    record->encoding = portion.is_integer_coded ? DE_INT32 : DE_STEIM2;
    // libmseed only reads the samples, but through a pointer that is not const.
    record->datasamples = const_cast<std::int32_t*>(samples.data());
    record->numsamples = static_cast<std::int64_t>(portion.sample_count);

    PackedRecord packed;
    packed.is_integer_coded = portion.is_integer_coded;
    packed.start = UtcTime(std::chrono::microseconds(record->starttime));
    std::int64_t sample_count = 0;
    constexpr flag kFlush = 1;
    const int record_count =
        msr_pack(record.get(), keep_first_record, &packed, &sample_count, kFlush, 0);
    record->datasamples = nullptr;  // Borrowed.
    if (record_count < 1)
        throw std::invalid_argument("pack_record: libmseed refuses a record of " + header.channel);
    if (header.declared_rate_hz) {
        // libmseed sets both rates from one number; here the fixed header keeps the nominal rate.
        put_float(packed.bytes, kBlockette100At + 4, static_cast<float>(*header.declared_rate_hz));
    }
    return packed;
}

namespace {

/// Decodes the bytes of a record, whose layout is ours.
std::optional<DecodedRecord> decode(std::span<const std::byte> bytes,
                                    const std::unique_lock<std::mutex>& /*libmseed*/) {
    std::array<char, kRecordSize> copy{};
    std::memcpy(copy.data(), bytes.data(), kRecordSize);
    MSRecord* parsed = nullptr;
    constexpr flag kWithSamples = 1;
    const int error = msr_parse(copy.data(), static_cast<int>(copy.size()), &parsed,
                                static_cast<int>(kRecordSize), kWithSamples, 0);
    const std::unique_ptr<MSRecord, FreeRecord> record(parsed);
    if (error != MS_NOERROR || !record || record->numsamples != record->samplecnt ||
        record->sampletype != 'i') {
        return std::nullopt;
    }
    DecodedRecord decoded;
    decoded.header = header_of(bytes, *record);
    const auto* samples = static_cast<const std::int32_t*>(record->datasamples);
    decoded.samples.assign(samples, samples + record->numsamples);
    if (!do_steim_ends_agree(bytes, decoded.samples)) return std::nullopt;
    return decoded;
}

}  // namespace

std::optional<DecodedRecord> decode_record(std::span<const std::byte> bytes) {
    if (bytes.size() != kRecordSize || !is_layout_ours(bytes)) return std::nullopt;
    return decode(bytes, lock_libmseed());
}

std::vector<FoundRecord> find_records(std::span<const std::byte> bytes,
                                      const std::string& channel) {
    std::vector<FoundRecord> found;
    // Locked once: to lock each record costs two threads a tenth of the time of reading a day.
    const auto lock = lock_libmseed();
    for (std::size_t at = 0; at + kRecordSize <= bytes.size();) {
        const auto candidate = bytes.subspan(at, kRecordSize);
        auto record = is_layout_ours(candidate) ? decode(candidate, lock) : std::nullopt;
        const bool is_found = record && record->header.channel == channel;
        if (is_found) found.push_back({at, std::move(*record)});
        at += is_found ? kRecordSize : 1;
    }
    return found;
}

UtcTime DecodedRecord::last_sample() const {
    return header.start + from_seconds(static_cast<double>(samples.size() - 1) / rate_hz());
}

int timing_quality_percent(Nanoseconds uncertainty) {
    const double decades = std::log10(static_cast<double>(uncertainty.count()) / 1e6);
    if (!(decades > 0.0)) return 100;
    return static_cast<int>(std::lround(std::max(0.0, 100.0 - 20.0 * decades)));
}

}  // namespace a351::archive
