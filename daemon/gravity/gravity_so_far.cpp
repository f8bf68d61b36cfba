#include "daemon/gravity/gravity_so_far.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "protocol/text/json_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::gravity {
namespace {

using std::chrono::steady_clock;

/// Reasons without a cause, in words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kReasons{{
    {"not_yet", text::marked("not computed yet")},
    {"off", text::marked("switched off by gravity_every_min = 0")},
    {"no_sites", text::marked("the configuration names no table of sites")},
}};

/// Returns a document without figures.
nlohmann::ordered_json empty_document() {
    nlohmann::ordered_json document;
    for (const char* const name :
         {"as_of_utc", "data_to_utc", "reason", "reason_text", "reason_parts", "model"})
        document[name] = nullptr;
    for (const char* const name : {"stays", "findings"})
        document[name] = nlohmann::ordered_json::array();
    return document;
}

/// Returns true if a text is one JSON object.  It is checked without a copy in memory.
bool is_object(const std::string& text) {
    return text.starts_with('{') && nlohmann::json::accept(text);
}

/// Returns the code of a run without a document.
std::string reason_of(child::Outcome outcome) {
    using enum child::Outcome;
    switch (outcome) {
        case missing:
            return "no_corrector";
        case killed:
            return "killed";
        case too_slow:
            return "too_slow";
        case too_much_output:
            return "too_much_output";
        default:
            return "failed";
    }
}

}  // namespace

GravityOptions options_for(const std::filesystem::path& corrector, const SurveyFiles& files,
                           std::chrono::milliseconds every) {
    GravityOptions options;
    options.every = every;
    options.reason = every.count() == 0 ? "off" : files.sites.empty() ? "no_sites" : "";
    if (!options.reason.empty()) return options;
    options.command = {corrector, "survey", files.root, "--sites", files.sites, "--json"};
    if (!files.calibration.empty())
        options.command.insert(options.command.end(), {"--calibration", files.calibration});
    return options;
}

GravitySoFar::GravitySoFar(GravityOptions options) : options_(std::move(options)) { use(options_); }

void GravitySoFar::use(const GravityOptions& options) {
    const std::lock_guard lock(mutex_);
    if (options.command != command_ || command_.empty()) {
        command_ = options.command;
        reason_ = command_.empty() ? options.reason : "not_yet";
        cause_.clear();
        document_.clear();
    }
    if (last_run_) now_ = steady_clock::now();  // The list or the calibration may be another one.
    woken_.notify_all();
}

void GravitySoFar::stop() {
    std::unique_lock lock(mutex_);
    stop_ = true;
    lock.unlock();
    woken_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void GravitySoFar::note_change(bool is_running) {
    const std::lock_guard lock(mutex_);
    is_stay_running_ = is_running;
    now_ = steady_clock::now();
    again_ = *now_ + options_.again;
    woken_.notify_all();
}

std::string GravitySoFar::document() const {
    const std::lock_guard lock(mutex_);
    if (reason_.empty()) return document_;
    auto document = document_.empty() ? empty_document() : nlohmann::ordered_json::parse(document_);
    document["reason"] = reason_;
    document["reason_text"] = document["reason_parts"] = nullptr;
    if (!cause_.empty()) document["reason_text"] = cause_;
    for (const auto& [reason, words] : kReasons) {
        if (reason != reason_) continue;
        document["reason_text"] = words;
        document["reason_parts"] = text::marked_message(words).to_json();
    }
    return text::json_text(document) + '\n';
}

std::optional<GravitySoFar::Time> GravitySoFar::next_run() const {
    std::optional<Time> next;
    const auto add = [&next](const std::optional<Time>& time) {
        if (time && (!next || *time < *next)) next = time;
    };
    add(now_);
    add(again_);
    if (is_stay_running_ && last_run_) add(*last_run_ + options_.every);
    return next;
}

void GravitySoFar::run() {
    std::unique_lock lock(mutex_);
    while (!stop_) {
        const auto next = command_.empty() ? std::nullopt : next_run();
        const auto now = steady_clock::now();
        if (!next) {
            woken_.wait(lock);
        } else if (now < *next) {
            woken_.wait_until(lock, *next);
        } else {
            now_.reset();
            if (again_ && *again_ <= now) again_.reset();
            last_run_ = now;
            auto command = command_;
            lock.unlock();
            Answer answer = ask(command);
            lock.lock();
            if (command == command_) take(std::move(answer));
        }
    }
}

GravitySoFar::Answer GravitySoFar::ask(std::vector<std::string> command) const {
    try {
        child::ChildEnd end = child::run_child({.words = std::move(command), .is_background = true},
                                               options_.limits, &stop_);
        if (end.outcome != child::Outcome::good)
            return {{}, reason_of(end.outcome), std::move(end.message)};
        if (is_object(end.output)) return {std::move(end.output), {}, {}};
        return {{}, "no_document", "its output is not a JSON object"};
    } catch (const std::exception& error) {
        return {{}, "failed", error.what()};
    }
}

void GravitySoFar::take(Answer answer) {
    if (stop_) return;
    if (answer.reason.empty()) {
        document_ = std::move(answer.document);
        reason_.clear();
        cause_.clear();
        return;
    }
    const bool is_new = answer.reason != reason_;
    reason_ = std::move(answer.reason);
    cause_ = std::move(answer.cause);
    if (is_new && options_.failed) options_.failed(reason_, cause_);
}

}  // namespace a351::daemon::gravity
