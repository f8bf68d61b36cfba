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
    const std::filesystem::path folder = survey.path.parent_path();
    const auto origin = survey.amendments;
    if (file.empty())
        file =
            origin.empty() ? folder / (survey.path.stem().string() + "-amendments.toml") : origin;
    std::string text = std::filesystem::exists(file) ? text::read_text_file(file) : "";
    if (!text.empty() && !text.ends_with('\n')) text += '\n';
    for (const reading::Finding& finding : findings)
        text += fmt::format("# {}\n{}", finding.text, finding.amendment);

    const Candidate candidate(file.string() + ".candidate");
    text::write_together(file.parent_path().empty() ? "." : file.parent_path(),
                         {{candidate.file().filename().string(), text}});
    SurveyFile tried = survey;
    tried.amendments = candidate.file();
    static_cast<void>(reading::read_survey_inputs(tried));  // refuses what contradicts

    std::filesystem::path named = std::filesystem::relative(file, folder.empty() ? "." : folder);
    if (named.empty()) named = std::filesystem::absolute(file);
    text::write_together(file.parent_path().empty() ? "." : file.parent_path(),
                         {{file.filename().string(), text}});
    const std::string before = text::read_text_file(survey.path);
    const std::string after = with_amendments_key(before, named.string());
    if (after != before)
        text::write_together(folder.empty() ? "." : folder,
                             {{survey.path.filename().string(), after}});
    return file;
}

}  // namespace a351::corrector::job
