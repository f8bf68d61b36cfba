#include "daemon/ctl/terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "protocol/text/columns.hpp"

namespace a351::daemon::ctl {
namespace {

// Alternate screen, no cursor, no wrapping of long lines; and back.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l\x1b[?7l";
constexpr std::string_view kLeave = "\x1b[0m\x1b[?7h\x1b[?25h\x1b[?1049l";

// A signal handler needs them.
termios g_before{};  ///< Settings of standard input.
bool g_has_keys = false;

void write_all(std::string_view text) {
    while (!text.empty()) {
        const auto written = write(STDOUT_FILENO, text.data(), text.size());
        if (written < 0 && errno != EINTR) return;
        text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
}

void leave() {
    write_all(kLeave);
    if (g_has_keys) tcsetattr(STDIN_FILENO, TCSANOW, &g_before);
}

/// Returns true if a line must not begin with the letter at this place: a Japanese comma, stop or
/// closing bracket.
bool ends_a_phrase(std::string_view text) {
    return text.starts_with("\u3001") || text.starts_with("\u3002") || text.starts_with("\uFF09") ||
           text.starts_with("\u300D");
}

}  // namespace

bool is_screen() {
    const char* const kind = std::getenv("TERM");
    return isatty(STDOUT_FILENO) != 0 && (kind == nullptr || std::string_view(kind) != "dumb");
}

bool wants_colour() {
    const char* const no_colour = std::getenv("NO_COLOR");
    return is_screen() && (no_colour == nullptr || *no_colour == '\0');
}

Terminal::Terminal() {
    g_has_keys = isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &g_before) == 0;
    // While a request waits for a daemon that hangs, no loop could look at a flag.
    struct sigaction action {};
    action.sa_handler = [](int) {
        leave();
        _exit(0);
    };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
    action.sa_handler = [](int) {};  // Ends the wait for keys.
    sigaction(SIGWINCH, &action, nullptr);
    if (g_has_keys) {
        termios settings = g_before;
        settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        settings.c_cc[VSUSP] = settings.c_cc[VQUIT] = _POSIX_VDISABLE;
        settings.c_cc[VMIN] = 1;
        settings.c_cc[VTIME] = 0;
        tcsetattr(STDIN_FILENO, TCSANOW, &settings);
    }
    write_all(kEnter);
}

Terminal::~Terminal() { leave(); }

TerminalSize Terminal::size() const {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
        return {};
    return {size.ws_col, size.ws_row};
}

void Terminal::show(const std::string& screen, bool is_typing) const {
    std::string drawn = "\x1b[?25l\x1b[H";
    for (const char c : screen) drawn += c == '\n' ? "\x1b[K\n" : std::string(1, c);
    write_all(drawn + "\x1b[0m\x1b[K" + (is_typing ? "\x1b[?25h" : "\x1b[J"));
}

std::optional<std::string> Terminal::keys(int wait_ms) const {
    pollfd input{.fd = g_has_keys ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, std::max(wait_ms, 0)) <= 0) return "";
    char bytes[256];
    const auto got = read(STDIN_FILENO, bytes, sizeof bytes);
    if (got <= 0) return std::nullopt;
    return std::string(bytes, static_cast<std::size_t>(got));
}

std::string fitted(const std::string& screen, std::size_t columns, std::size_t rows) {
    constexpr std::size_t kIndent = 13;  // that of line()
    std::string shown;
    // The last place at which the line can be broken, the bytes of the blank there, and its column.
    std::size_t row = 0, column = 0, break_at = std::string::npos, blank = 0, after_break = 0;
    for (std::size_t i = 0; i < screen.size() && row < rows; ++i) {
        const char c = screen[i];
        if (c == '\x1b') {  // A colour takes no place.
            const std::size_t end = std::min(screen.find('m', i), screen.size() - 1);
            shown.append(screen, i, end - i + 1);
            i = end;
            continue;
        }
        shown += c;
        if (c == '\n') {
            ++row;
            column = 0;
            break_at = std::string::npos;
            continue;
        }
        const std::size_t width = text::columns_of({&c, 1});
        if (width == 0) continue;
        column += width;
        const bool is_wide = width == 2 && !ends_a_phrase(std::string_view(screen).substr(i));
        if ((c == ' ' || is_wide) && column > kIndent + 2) {
            break_at = shown.size() - 1;
            blank = is_wide ? 0 : 1;
            after_break = is_wide ? column - 2 : column;
        }
        if (column < columns || break_at == std::string::npos) continue;
        if (++row == rows) {
            shown.resize(break_at);
            if (shown.find('\x1b') != std::string::npos)
                shown += "\x1b[0m";  // It may not have ended.
            break;
        }
        shown.replace(break_at, blank, "\n" + std::string(kIndent, ' '));
        column = column - after_break + kIndent;
        break_at = std::string::npos;
    }
    // The line end of the last row would scroll the first one away.
    if (shown.ends_with('\n')) shown.pop_back();
    return shown;
}

}  // namespace a351::daemon::ctl
