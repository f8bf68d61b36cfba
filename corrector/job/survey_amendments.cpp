#include "corrector/job/survey_amendments.hpp"

#include <fmt/core.h>

#include <regex>

#include "protocol/core/input_error.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/text/text_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::job {
namespace {

/// Removes a file at the end of a scope.
class Candidate {
public:
    explicit Candidate(std::filesystem::path file) : file_(std::move(file)) {}
    Candidate(const Candidate&) = delete;
    Candidate& operator=(const Candidate&) = delete;
    Candidate(Candidate&&) = delete;
    Candidate& operator=(Candidate&&) = delete;
    ~Candidate() {
        std::error_code ignored;
        std::filesystem::remove(file_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
};

}  // namespace

std::string with_amendments_key(const std::string& text, const std::string& value) {
    const std::string line = "amendments = " + text::toml_string(value);
    static const std::regex kKey(R"((^|\n)[ \t]*amendments[ \t]*=[^\n#]*)"),
        kTable(R"((^|\n)[ \t]*\[[ \t]*survey[ \t]*\][^\n]*)");
    std::smatch found;
    if (std::regex_search(text, found, kKey))
        return fmt::format("{}{}{}{}", found.prefix().str(), found[1].str(), line,
                           found.suffix().str());
    if (!std::regex_search(text, found, kTable))
        throw InputError("survey file: no line [survey]; allowed: one, or the key amendments");
    return fmt::format("{}{}\n{}{}", found.prefix().str(), found.str(), line, found.suffix().str());
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
        text += fmt::format("# {}\n{}", finding.text, finding.amendment);
    std::string named_survey = text::read_text_file(survey.path);
    if (file != origin)
        named_survey = with_amendments_key(
            named_survey, std::filesystem::proximate(file, folder_of(survey.path)).string());

    const Candidate candidate(file.string() + ".candidate");
    text::write_together(folder_of(file), {{candidate.file().filename().string(), text}});
    SurveyFile tried = survey;
    tried.amendments = candidate.file();
    static_cast<void>(reading::read_survey_inputs(tried));  // refuses what contradicts

    if (file == origin) {
        text::write_together(folder_of(file), {{file.filename().string(), text}});
    } else if (folder_of(file) == folder_of(survey.path)) {
        text::write_together(folder_of(file), {{file.filename().string(), text},
                                               {survey.path.filename().string(), named_survey}});
    } else {
        text::write_together(folder_of(file), {{file.filename().string(), text}});
        text::write_together(folder_of(survey.path),
                             {{survey.path.filename().string(), named_survey}});
    }
    return file;
}

}  // namespace a351::corrector::job
