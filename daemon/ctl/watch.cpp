#include "daemon/ctl/watch.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemon/ctl/requests.hpp"
#include "daemon/ctl/screen.hpp"
#include "daemon/ctl/site_names.hpp"
#include "daemon/ctl/survey_text.hpp"
#include "daemon/ctl/terminal.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/columns.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRefresh{1000};
constexpr std::chrono::seconds kRefreshGravity{5};  ///< It changes after a stop, and every few min.
constexpr std::chrono::minutes kAnswerShown{1};  ///< Time for which an answer stays on the screen.
constexpr std::size_t kAnswerRows = 3;           ///< Place of an answer, which may be a long line.
constexpr char kEscape = '\x1b', kEraseLine = '\x15', kDelete = '\x7f', kBackspace = '\b';

volatile std::sig_atomic_t g_stop = 0;

std::string reversed(const std::string& text, bool is_reversed) {
    return is_reversed ? "\x1b[7m" + text + "\x1b[0m" : text;
}

std::string warned(const std::string& text, bool is_coloured) {
    return is_coloured ? "\x1b[1;31m" + text + "\x1b[0m" : text;
}

/// Removes the last letter of UTF-8.
void erase_letter(std::string& text) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80)
        text.pop_back();
    if (!text.empty()) text.pop_back();
}

/// The screen of `watch` on a terminal: the last status, and what the operator is asked.
class Watch {
public:
    Watch(const Client& client, std::string token, std::string operator_name)
        : client_(client), token_(std::move(token)), operator_(std::move(operator_name)) {}

    void run() {
        const Terminal terminal;
        auto due = Clock::now();
        while (true) {
            if (Clock::now() >= due) {
                refresh();
                due = Clock::now() + kRefresh;
            }
            terminal.show(screen(terminal.size()), is_typing());
            const auto wait =
                std::chrono::duration_cast<std::chrono::milliseconds>(due - Clock::now());
            const auto keys = terminal.keys(static_cast<int>(wait.count()));
            if (!keys || !take(*keys)) return;
        }
    }

private:
    enum class Question { none, site, other_site, stop, note };

    void refresh() {
        try {
            Answer answer = answer_of(client_.get("/api/status"));
            status_ = answer.error.empty() ? std::move(answer.body) : json();
            trouble_ = printable(answer.error);
            if (Clock::now() < gravity_due_) return;
            gravity_due_ = Clock::now() + kRefreshGravity;
            const Answer survey = answer_of(client_.get("/api/survey"));
            gravity_ = survey.error.empty() ? newest_gravity(survey.body) : "";
        } catch (const NoDaemon& error) {
            status_ = json();
            trouble_ = printable(error.what());
        }
    }

    /// Returns the running stay; null if there is none.
    [[nodiscard]] json stay() const {
        return status_.is_object() ? status_.value("occupation", json()) : json();
    }

    [[nodiscard]] bool is_typing() const {
        return question_ == Question::site || question_ == Question::note;
    }

    [[nodiscard]] std::string screen(const TerminalSize& size) const {
        const bool is_coloured = wants_colour();
        std::string answer;
        if (!answer_.empty() && Clock::now() - answered_ < kAnswerShown)
            answer = fitted(fmt::format("{:13}", text::tr("answer")) +
                                (is_refused_ ? warned(answer_, is_coloured) : answer_),
                            size.columns, kAnswerRows) +
                     "\n";
        const auto lines = [](const std::string& text) {
            return static_cast<std::size_t>(std::ranges::count(text, '\n'));
        };
        const std::size_t below = lines(answer) + 1;
        const std::size_t rows = size.rows > below ? size.rows - below : 1;
        std::string above =
            fitted(status_.is_object() ? watch_screen(status_, gravity_, is_coloured)
                                       : "a351d        " + warned(trouble_, is_coloured) + "\n",
                   size.columns, rows);
        above.append(rows - std::min(rows, lines(above)), '\n');
        return above + answer + fitted(bottom_row(size.columns), size.columns, 1);
    }

    /// Returns the question, or the keys that do something now.
    [[nodiscard]] std::string bottom_row(std::size_t columns) const {
        switch (question_) {
            case Question::site:
                return prompt(text::tr("start at (Tab completes, Esc cancels): "), columns);
            case Question::note:
                return prompt(text::tr("note (Esc cancels): "), columns);
            case Question::other_site:
                return text::tr("did you mean {}? y: start there, any other key: cancel",
                                printable(other_site_));
            case Question::stop: {
                const std::string site = printable(asked_stay_.value("site", ""));
                if (!moved_utc_) return text::tr("stop {}? y: stop, any other key: cancel", site);
                return text::tr(
                    "stop {} at {}, when the box was moved? y: then, n: now, others: cancel", site,
                    to_rfc3339(*moved_utc_).substr(11, 8));
            }
            case Question::none:
                break;
        }
        const json running = stay();
        if (!running.is_object()) return text::tr("s start   n note   q quit");
        const bool is_next = running.value("propose_set_up", false);
        return reversed(text::tr("x stop"), running.value("may_stop", false) && !is_next) + "   " +
               reversed(text::tr("u next set-up"), is_next) +
               (running.value("moved", json()).is_object() ? "   " + text::tr("m not moved") : "") +
               "   " + text::tr("n note   q quit");
    }

    /// Returns a question and, after it, as much of the end of the typed text as there is room for.
    [[nodiscard]] std::string prompt(const std::string& question, std::size_t columns) const {
        std::string shown = printable(typed_);
        while (!shown.empty() &&
               text::columns_of(question) + text::columns_of(shown) + 1 >= columns) {
            std::size_t letter = 1;
            while (letter < shown.size() &&
                   (static_cast<unsigned char>(shown[letter]) & 0xC0U) == 0x80)
                ++letter;
            shown.erase(0, letter);
        }
        return question + shown;
    }

    void say(const std::string& answer, bool is_refused = false) {
        answer_ = answer;
        is_refused_ = is_refused;
        answered_ = Clock::now();
    }

    /// Takes keys.  @return false to quit
    bool take(const std::string& keys) {
        for (const char key : keys.substr(0, keys.find(kEscape))) {
            if (question_ == Question::none && key == 'q') return false;
            take(key);
        }
        // More bytes belong to an arrow key and the like, which do nothing.
        if (keys.ends_with(kEscape)) ask(Question::none);
        return true;
    }

    void take(char key) {
        const Question question = question_;
        if (question == Question::none) return take_command(key);
        if (is_typing()) return take_letter(key);
        ask(Question::none);
        const bool is_now = question == Question::stop && moved_utc_ && key == 'n';
        if (key != 'y' && !is_now) return say(text::tr("nothing was changed"));
        if (question == Question::other_site) return start(other_site_);
        json order = asked_stay_;
        if (moved_utc_ && !is_now) order["at"] = to_rfc3339(*moved_utc_, 9);
        send("stop", order);
    }

    void take_command(char key) {
        const json running = stay();
        const bool is_running = running.is_object();
        if (key == 'n') return ask(Question::note);
        if (key == 's') {
            if (is_running)
                return say(
                    text::tr("{} is running: stop it first", printable(running.value("site", ""))),
                    true);
            return ask_site();
        }
        if (key != 'x' && key != 'u' && key != 'm') return;
        if (!is_running) return say(text::tr("no occupation is running"), true);
        if (key == 'm') return send("not_moved", named());
        if (key == 'u') return send("setup", named());
        const int made = running.value("set_up_count", 1);
        const int planned = running.value("planned_set_ups", 1);
        std::string doubts;
        if (made < planned) doubts = text::tr("{} of {} planned set-ups; ", made, planned);
        const std::string state = status_.value("/verdict/state"_json_pointer, "unknown");
        say(doubts +
            text::tr("the verdict is {}", printable(text::translated(state, text::language()))));
        asked_stay_ = named();
        // A stay that was started too early has its move at the start: nothing to stop there.
        const json moved = running.value("moved", json());
        const bool is_later = moved.is_object() && !moved.value("is_at_start", false);
        moved_utc_ = is_later ? parse_rfc3339(moved.value("utc", "")) : std::nullopt;
        ask(Question::stop);
    }

    void take_letter(char key) {
        if (key == '\n' || key == '\r')
            return question_ == Question::site ? enter_site() : write_note();
        if (key == '\t' && question_ == Question::site) return complete_site();
        if (key == kDelete || key == kBackspace) return erase_letter(typed_);
        if (key == kEraseLine) return typed_.clear();
        if (static_cast<unsigned char>(key) >= ' ') typed_ += key;
    }

    void ask(Question question) {
        question_ = question;
        typed_.clear();
    }

    void ask_site() {
        try {
            sites_ = SiteNames(answer_of(client_.get("/api/sites")).body);
        } catch (const NoDaemon& error) {
            return say(printable(error.what()), true);
        }
        say(sites_.empty() ? text::tr("there is no list of sites; any name is accepted")
                           : text::tr("nearest sites: {}", printable(sites_.beginning_with(""))));
        ask(Question::site);
    }

    void complete_site() {
        const auto completed = sites_.completed(typed_);
        if (!completed) return say(text::tr("no site begins with {}", printable(typed_)), true);
        typed_ = *completed;
        say(text::tr("sites: {}", printable(sites_.beginning_with(typed_))));
    }

    void enter_site() {
        const std::string typed = typed_;
        ask(Question::none);
        if (typed.empty()) return;
        const auto meant = sites_.meant_by(typed);
        if (!meant) return start(typed);
        other_site_ = *meant;
        say(text::tr("{} is not in the list of sites", printable(typed)));
        ask(Question::other_site);
    }

    void start(const std::string& site) { send("start", {{"site", site}}); }

    void write_note() {
        json body = named();
        body["note"] = typed_;
        const bool is_empty = typed_.empty();
        ask(Question::none);
        if (!is_empty) send_to("/api/note", body);
    }

    /// Names the stay that is shown, so that the daemon refuses if another one runs by now.
    [[nodiscard]] json named() const {
        const json running = stay();
        if (!running.is_object()) return json::object();
        return {{"key", running.value("key", "")}, {"site", running.value("site", "")}};
    }

    void send(const std::string& change, json body) {
        if (!operator_.empty() && change != "setup") body["operator"] = operator_;
        send_to("/api/occupation/" + change, body);
    }

    void send_to(const std::string& path, const json& body) {
        try {
            const Answer answer = send_change(client_, token_, path, body);
            say(answer.error.empty() ? message_of(answer) : printable(answer.error),
                !answer.error.empty());
        } catch (const NoDaemon& error) {
            say(printable(error.what()), true);
        }
        refresh();
    }

    const Client& client_;
    std::string token_, operator_;
    json status_;          ///< Null if the daemon does not answer.
    std::string trouble_;  ///< Why not.
    std::string gravity_;  ///< Gravity so far, one line.
    Clock::time_point gravity_due_;
    Question question_ = Question::none;
    std::string typed_;
    json asked_stay_;                   ///< Stay that is to be stopped.
    std::optional<UtcTime> moved_utc_;  ///< When its box was moved, if it was.
    std::string other_site_;            ///< Name that the operator may have meant.
    SiteNames sites_;
    std::string answer_;
    bool is_refused_ = false;
    Clock::time_point answered_;
};

/// Prints the screen of `status` every second until SIGINT or SIGTERM.
void print_screens(const Client& client) {
    struct sigaction action {};
    action.sa_handler = [](int) { g_stop = 1; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    while (!g_stop) {
        std::string screen;
        try {
            const Answer answer = answer_of(client.get("/api/status"));
            screen = answer.error.empty() ? status_screen(answer.body, false)
                                          : printable(answer.error) + "\n";
        } catch (const NoDaemon& error) {
            screen = std::string(error.what()) + "\n";
        }
        screen += "\n";
        std::fwrite(screen.data(), 1, screen.size(), stdout);
        std::fflush(stdout);
        if (!g_stop) poll(nullptr, 0, static_cast<int>(kRefresh.count()));  // Ends with a signal.
    }
}

}  // namespace

void watch(const Client& client, const std::string& token, const std::string& operator_name) {
    if (!is_screen()) return print_screens(client);
    Watch(client, token, operator_name).run();
}

}  // namespace a351::daemon::ctl
