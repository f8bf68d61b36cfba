#include "corrector/job/survey_amendments.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/removed_at_end.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::job {
namespace {

/// Returns the lines of a text with their ends.
std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t from = 0, end = 0; from < text.size(); from = end) {
        end = text.find('\n', from);
        end = end == std::string::npos ? text.size() : end + 1;
        lines.push_back(text.substr(from, end - from));
    }
    return lines;
}

std::string without_blanks(std::string line) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t'; });
    return line;
}

/// Returns a sentence as a comment of TOML: names of sites can have control characters.
std::string comment_of(std::string sentence) {
    std::ranges::replace_if(
        sentence, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return "# " + sentence + '\n';
}

}  // namespace

std::string with_amendments_key(const std::string& text, const std::string& value) {
    const std::string line = "amendments = " + text::toml_string(value) + '\n';
    std::vector<std::string> lines = lines_of(text);
    const auto begins_with = [&lines](std::string_view beginning) {
        return std::ranges::find_if(lines, [beginning](const std::string& one) {
            return without_blanks(one).starts_with(beginning);
        });
    };
    if (const auto key = begins_with("amendments="); key != lines.end()) {
        *key = line;
    } else if (const auto table = begins_with("[survey]"); table != lines.end()) {
        if (!table->ends_with('\n')) *table += '\n';
        lines.insert(table + 1, line);
    } else {
        throw InputError("no line [survey]; allowed: one, behind which the key amendments is put");
    }
    return text::joined(lines, "");
}

std::filesystem::path add_amendments(const SurveyFile& survey,
                                     const std::vector<reading::Finding>& findings,
                                     std::filesystem::path file) {
    const auto folder_of = [](const std::filesystem::path& of) {
        return of.parent_path().empty() ? std::filesystem::path(".") : of.parent_path();
    };
    const std::filesystem::path& origin = survey.amendments;
    if (file.empty())
        file = !origin.empty()
                   ? origin
                   : folder_of(survey.path) / (survey.path.stem().string() + "-amendments.toml");
    if (file != origin && std::filesystem::exists(file))
        throw InputError(
            fmt::format("{}: exists, and {} does not name it; allowed: a new file, or "
                        "the one of the survey",
                        file.string(), survey.path.string()));
    std::string text = origin.empty() ? "" : text::read_text_file(origin);
    if (!text.empty() && !text.ends_with('\n')) text += '\n';
    for (const reading::Finding& finding : findings)
        text += comment_of(finding.text) + finding.amendment;
    std::string named_survey;
    if (file != origin) try {
            named_survey = with_amendments_key(
                text::read_text_file(survey.path),
                std::filesystem::proximate(file, folder_of(survey.path)).string());
        } catch (const InputError& error) {
            throw InputError(survey.path.string() + ": " + error.what());
        }

    const text::RemovedAtEnd candidate(file.string() + ".candidate");
    text::write_together(folder_of(file), {{candidate.path().filename().string(), text}});
    SurveyFile tried = survey;
    tried.amendments = candidate.path();
    static_cast<void>(reading::units_of(tried));  // refuses what contradicts
    std::vector<text::NamedText> files{{file.filename().string(), text}};
    const text::NamedText named{survey.path.filename().string(), named_survey};
    const bool is_beside = folder_of(file) == folder_of(survey.path);
    if (file != origin && is_beside) files.push_back(named);
    text::write_together(folder_of(file), files);
    if (file != origin && !is_beside) text::write_together(folder_of(survey.path), {named});
    return file;
}

}  // namespace a351::corrector::job
