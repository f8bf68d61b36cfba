#include "daemon/status/status_log.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <sstream>

namespace a351::daemon::status {
namespace {

constexpr std::chrono::minutes kReminder{1};

/// Returns the reason without its paths: each try to write the journal may name another file.
std::string without_paths(const std::string& reason) {
    std::istringstream words(reason);
    std::string kept;
    for (std::string word; words >> word;)
        if (word.find('/') == std::string::npos) kept += word + ' ';
    return kept;
}

}  // namespace

void StatusLog::note(const Status& status, Instant now) {
    const auto is_new = [](std::string& last, const std::string& present) {
        return std::exchange(last, present) != present;
    };
    if (is_new(link_state_, status.link_state))
        log_->info("link: {} ({})", status.link_state,
                   status.link_trouble.empty() ? status.port : status.link_trouble);
    if (is_new(session_, status.session))
        log_->info("session {}: {} serial {}, {} Hz, {}", status.session, status.product_id,
                   status.serial_number, status.output_rate_hz, status.filter);
    note_oven("oven", status.oven, now);
    note_oven("outer oven", status.outer_oven, now);
    if (is_new(reserve_, status.disk_reserve))
        log_->info("reserve for a full disk: {}{}{}", status.disk_reserve,
                   status.disk_reserve_trouble.empty() ? "" : ": ", status.disk_reserve_trouble);
    if (rate_advice_.empty() && !status.rate_advice.empty())
        log_->info("rate: {}", status.rate_advice);
    rate_advice_ = status.rate_advice;
    if (status.leap != leap_ && status.leap != timing::LeapSecond::none)
        log_->info("clock: a leap second is {} at the end of this UTC day",
                   status.leap == timing::LeapSecond::inserted ? "inserted" : "removed");
    leap_ = status.leap;
    note_reasons(status, now);
    note_counter("gaps", status.counters.gaps, now);
    note_counter("checksum errors", status.counters.checksum_errors, now);
    note_counter("framing errors", status.counters.framing_errors, now);
    note_counter("counter anomalies", status.counters.anomalies, now);
    note_counter("duplicates", status.counters.duplicates, now);
    note_counter("frames with error flags", status.counters.error_flags, now);
    for (const char* name : {"link_stalls", "ports_lost", "journal_faults", "reads_dropped",
                             "archive_faults", "archive_chunks_lost"}) {
        const auto found = status.more_counters.find(name);
        if (found != status.more_counters.end()) note_counter(name, found->second, now);
    }
}

void StatusLog::note_oven(const std::string& name,
                          const std::optional<source::OvenLinkStatus>& oven, Instant now) {
    if (!oven) return;
    const std::string state = source::to_text(oven->state);
    if (std::exchange(oven_states_[name], state) != state)
        log_->info("{}: {} ({})", name, state, oven->trouble.empty() ? oven->port : oven->trouble);
    for (const auto& [outcome, count] : source::polls_by_outcome(*oven))
        if (outcome != "answered") note_counter(name + " polls " + outcome, count, now);
}

void StatusLog::note_reasons(const Status& status, Instant now) {
    for (const std::string& reason : status.reasons) {
        Trouble& trouble = troubles_[without_paths(reason)];
        ++trouble.times;
        trouble.reason = reason;
        if (trouble.times == 1) {
            log_->warn("{}", reason);
            trouble.said = now;
        } else if (now - trouble.said >= kReminder) {
            log_->warn("{} (seen {} times)", reason, trouble.times);
            trouble.said = now;
        }
    }
    std::erase_if(troubles_, [&](const auto& entry) {
        if (std::ranges::count(status.reasons, entry.first, without_paths) > 0) return false;
        log_->info("resolved: {}", entry.second.reason);
        return true;
    });
}

void StatusLog::note_counter(const std::string& name, std::uint64_t value, Instant now) {
    Counter& counter = counters_[name];
    if (value <= counter.said_value) return;
    if (counter.said_value > 0 && now - counter.said < kReminder) return;
    log_->warn("{}: {} more, {} in total", name, value - counter.said_value, value);
    counter = {value, now};
}

}  // namespace a351::daemon::status
