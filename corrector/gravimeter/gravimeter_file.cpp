#include "corrector/gravimeter/gravimeter_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Takes the next line from the text, without its end LF or CRLF.
std::string_view next_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

const std::vector<Format>& formats() {
    static const std::vector<Format> list = [] {
        std::vector<Format> all{cg5_format()};
        for (Format& format : named_formats()) all.push_back(std::move(format));
        for (const auto format : {cg6_export_format, burris_format, gcym_format})
            all.push_back(format());
        return all;
    }();
    return list;
}

/// Returns the format of a file.
/// @throws InputError  there is none; it names a form that is known and not read.
const Format& format_of(std::string_view text, const std::filesystem::path& path) {
    std::string unread;
    while (!text.empty()) {
        const std::string_view line = next_line(text);
        for (const Format& format : formats())
            if (format.begins_with(line)) return format;
        if (unread.empty()) unread = unread_form(line);
    }
    std::string names;
    for (const Format& format : formats())
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", format.name, format.forms);
    throw InputError(fmt::format("{}: {}; allowed: {}", path.string(),
                                 unread.empty() ? "not a file of a gravimeter" : unread, names));
}

}  // namespace

GravimeterFile read_gravimeter_file(const std::filesystem::path& path, const ReadOptions& options) {
    const std::string content = text::read_text_file(path);
    std::string_view text = content;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    const Format& format = format_of(text, path);
    GravimeterFile file;
    file.path = path;
    file.format = format.name;
    const auto reader = format.make_reader(options);
    if (!reader)
        throw InputError(fmt::format(
            "{}: a {} does not say the zone of its times; allowed: --zone +hh:mm, for example "
            "--zone +08:00 for Beijing time",
            path.string(), format.name));
    reader->look_at(text);
    std::vector<std::string> layouts;
    for (std::size_t number = 1; !text.empty(); ++number) {
        // 99999 is the end of a GCYM table, so that nothing of it can be missing.
        const bool is_cut = text.find('\n') == std::string_view::npos && trimmed(text) != "99999";
        Line line = reader->read(next_line(text));
        if (is_cut) line = Refusal{"the last line has no end, the file may be cut off"};
        if (auto* const refusal = std::get_if<Refusal>(&line)) {
            file.refused.push_back({number, std::move(refusal->reason)});
        } else if (auto* const reading = std::get_if<Reading>(&line)) {
            reading->line = number;
            file.readings.push_back(std::move(*reading));
            if (std::string layout = reader->layout();
                std::ranges::find(layouts, layout) == layouts.end())
                layouts.push_back(std::move(layout));
        } else {
            ++file.comment_count;
        }
    }
    if (std::string remark = reader->remark(); !remark.empty())
        layouts.push_back(std::move(remark));
    file.layout = fmt::format("{}", fmt::join(layouts, "; "));
    if (file.readings.empty() && file.refused.empty())
        throw InputError(fmt::format("{}: no reading of a {}; allowed: at least one", path.string(),
                                     file.format));
    if (file.readings.empty())
        throw InputError(fmt::format("{}:{}: {}; no reading of a {} is left, {} lines are refused",
                                     path.string(), file.refused[0].line, file.refused[0].reason,
                                     file.format, file.refused.size()));
    return file;
}

}  // namespace a351::corrector::gravimeter
