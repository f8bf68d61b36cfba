#include "protocol/text/csv_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <iterator>

#include "protocol/text/plain_text.hpp"

namespace a351::text {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Longest text in quotation marks, bytes: a spreadsheet's cell has at most 32767 characters
/// (Microsoft, "Excel specifications and limits").  A missing mark must not take the whole file.
constexpr std::size_t kLongestQuoted = 4 * 32767;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Returns true if a line begins a miniSEED record: six digits and a mark of quality (SEED 2.4,
/// chapter 8), or MS and the version (FDSN miniSEED 3).
bool is_miniseed(std::string_view line) {
    constexpr std::size_t kSequence = 6;
    return line.starts_with("MS\x03") ||
           (line.size() > kSequence + 1 && line.find_first_not_of("0123456789") == kSequence &&
            std::string_view("DRQM").find(line[kSequence]) != std::string_view::npos &&
            line[kSequence + 1] == ' ');
}

/// Returns the separator that a line `sep=;` before the header names for Excel; '\0' without one.
char named_separator(std::string_view line) {
    constexpr std::string_view kKey = "sep=";
    while (!line.empty() && (line.back() == '\r' || line.back() == '"')) line.remove_suffix(1);
    if (line.starts_with('"')) line.remove_prefix(1);
    if (line.size() != kKey.size() + 1 || !line.starts_with(kKey)) return '\0';
    return line.back();
}

/// Returns a line without its quoted parts.
std::string unquoted_part(std::string_view line) {
    std::string part;
    bool is_quoted = false;
    for (const char c : line) {
        if (c == '"') is_quoted = !is_quoted;
        if (!is_quoted) part += c;
    }
    return part;
}

}  // namespace

CsvLines::CsvLines(std::istream& in) : in_(in) {
    const int first = in_.peek();
    if (first != 0xFF && first != 0xFE) return;  // Neither byte is in UTF-8.
    in_.get();
    if (in_.peek() != (first == 0xFF ? 0xFE : 0xFF)) {
        in_.unget();
        return;
    }
    in_.get();
    encoding_ = first == 0xFF ? Encoding::utf16_little : Encoding::utf16_big;
}

bool CsvLines::next(bool with_blank_lines) {
    while (trouble_.empty() && read_line(text_)) {
        line_ = lines_read_;
        const bool is_blank = trimmed(text_).empty() && text_.find(separator_) == std::string::npos;
        const auto is_at_end = [&] {
            return in_.eof() || in_.peek() == std::istream::traits_type::eof();
        };
        if (is_blank && (separator_ == '\0' || !with_blank_lines || is_at_end())) continue;
        if (separator_ == '\0') {
            const char named = named_separator(text_);
            if (named != '\0') {
                separator_ = named;
                if (std::string_view(",;\t").find(named) == std::string_view::npos)
                    trouble_ = fmt::format("cells separated by {}; allowed: , ; or a tab{}", named,
                                           kHowToSave);
                continue;
            }
            if (!choose_separator()) return false;
        }
        return split();
    }
    return false;
}

bool CsvLines::read_line(std::string& line) {
    if (encoding_ != Encoding::utf8) return read_utf16_line(line);
    if (!std::getline(in_, line)) return false;
    if (++lines_read_ == 1 && line.starts_with(kByteOrderMark))
        line.erase(0, kByteOrderMark.size());
    return true;
}

bool CsvLines::read_utf16_line(std::string& line) {
    namespace utf = boost::locale::utf;
    line.clear();
    std::u16string units;
    bool has_units = false;
    for (int first = in_.get(); in_; first = in_.get()) {
        const int second = in_.get();
        if (!in_) break;  // half a character
        has_units = true;
        const bool is_little = encoding_ == Encoding::utf16_little;
        const auto unit =
            static_cast<char16_t>(is_little ? first | (second << 8) : second | (first << 8));
        if (unit == u'\n') break;
        units += unit;
    }
    if (!has_units) return false;
    ++lines_read_;
    for (auto at = units.cbegin(); at != units.cend();) {
        const auto point = utf::utf_traits<char16_t>::decode(at, units.cend());
        if (point == utf::illegal || point == utf::incomplete) {
            trouble_ = fmt::format("not valid UTF-16; allowed: UTF-8{}", kHowToSave);
            return false;
        }
        utf::utf_traits<char>::encode(point, std::back_inserter(line));
    }
    return true;
}

bool CsvLines::choose_separator() {
    const std::string part = unquoted_part(trimmed(text_));
    const auto has = [&](char c) { return part.find(c) != std::string::npos; };
    if (is_miniseed(text_))
        trouble_ =
            "a miniSEED file; allowed: a table (CSV), or miniSEED in the archive of a data root "
            "with metadata/station.xml";
    else if (has('\0'))
        trouble_ = fmt::format("UTF-16 without its mark, or no text; allowed: UTF-8{}", kHowToSave);
    else if (has('\r'))  // as a spreadsheet writes CSV (Macintosh)
        trouble_ = fmt::format("lines end in CR alone; allowed: LF or CRLF{}", kHowToSave);
    else if (has(',') && has(';'))
        trouble_ =
            fmt::format("the header has commas and semicolons; allowed: one of them{}", kHowToSave);
    // Where both are, a tab is a blank beside the separator.
    separator_ = has(';') ? ';' : !has(',') && has('\t') ? '\t' : ',';
    return trouble_.empty();
}

bool CsvLines::split() {
    cells_.clear();
    changed_.clear();
    for (std::size_t at = 0;;) {
        const std::size_t first = text_.find_first_not_of(separator_ == '\t' ? " " : " \t", at);
        if (first != std::string::npos && text_[first] == '"') {
            at = first;
            if (!take_quoted(at)) return false;
        } else {
            const std::size_t end = std::min(text_.find(separator_, at), text_.size());
            take(std::string_view(text_).substr(at, end - at));
            at = end;
        }
        if (at == text_.size()) return true;
        ++at;  // the separator
    }
}

/// Takes a cell in quotation marks, from the first mark at `at` to the separator behind it or the
/// end of the line.  A line break inside continues the cell on the next line.
bool CsvLines::take_quoted(std::size_t& at) {
    std::string cell;
    for (++at;;) {
        const std::size_t mark = text_.find('"', at);
        if (mark == std::string::npos) {
            const std::size_t end = text_.size() - (text_.ends_with('\r') ? 1 : 0);
            cell.append(text_, at, std::max(end, at) - at);
            cell += '\n';
            // The views of earlier cells refer to the text of their line.
            for (std::string_view& earlier : cells_) earlier = changed_.emplace_back(earlier);
            if (cell.size() > kLongestQuoted || !read_line(text_)) {
                trouble_ = fmt::format("a quotation mark that none closes; allowed: pairs{}",
                                       trouble_.empty() ? kHowToSave : "");
                return false;
            }
            at = 0;
            continue;
        }
        cell.append(text_, at, mark - at);
        at = mark + 1;
        if (at == text_.size() || text_[at] != '"') break;
        cell += '"';  // two of them are one
        ++at;
    }
    const std::size_t end = std::min(text_.find(separator_, at), text_.size());
    if (!trimmed(std::string_view(text_).substr(at, end - at)).empty()) {
        trouble_ =
            fmt::format("text behind a closing quotation mark; allowed: a separator{}", kHowToSave);
        return false;
    }
    at = end;
    take(changed_.emplace_back(std::move(cell)));
    return true;
}

void CsvLines::take(std::string_view cell) {
    cell = trimmed(cell);
    if (!is_ascii(cell)) cell = trimmed(changed_.emplace_back(plain_text(cell)));
    cells_.push_back(cell);
}

}  // namespace a351::text
