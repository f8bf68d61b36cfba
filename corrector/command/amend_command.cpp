#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/job/survey_amendments.hpp"
#include "corrector/job/survey_day.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/job/survey_units.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/progress_bar.hpp"

namespace a351::corrector::command {
namespace {

struct AmendOptions {
    std::filesystem::path survey, out;
    std::vector<int> findings;
    bool is_all = false;
};

std::vector<reading::Finding> findings_of(const job::SurveyFile& survey) {
    std::vector<reading::Finding> findings;
    for (const job::SurveyFile& part : job::by_unit(survey)) {
        text::ProgressBar bar(part.name);
        reading::OccupationRows read = job::read_survey(part, std::ref(bar));
        std::ranges::move(job::correct_survey_day(part, read).findings,
                          std::back_inserter(findings));
    }
    return findings;
}

/// Returns the findings that are to be carried out.
std::vector<reading::Finding> chosen_findings(const std::vector<reading::Finding>& findings,
                                              const AmendOptions& options) {
    std::vector<reading::Finding> chosen;
    if (options.is_all) chosen = findings;
    std::vector<std::string> allowed;
    for (std::size_t k = 0; k < findings.size(); ++k)
        if (!findings[k].amendment.empty()) allowed.push_back(std::to_string(k + 1));
    for (const int number : std::set<int>(options.findings.begin(), options.findings.end())) {
        if (std::ranges::count(allowed, std::to_string(number)) == 0)
            throw InputError(fmt::format(
                "--finding = {}: no finding with a proposal; allowed: {}", number,
                allowed.empty() ? "none, because no finding has one" : text::joined(allowed)));
        chosen.push_back(findings[static_cast<std::size_t>(number - 1)]);
    }
    std::erase_if(chosen,
                  [](const reading::Finding& finding) { return finding.amendment.empty(); });
    return chosen;
}

/// Carries out what is found in the amended survey, until nothing more is found: a mistake can hide
/// another one.  A proposal that contradicts an amendment is only printed.
/// @return the number of amendments.
std::size_t amend_again(const std::filesystem::path& file) {
    constexpr int kMostRounds = 5;
    std::size_t count = 0;
    for (int round = 0; round < kMostRounds; ++round) {
        const std::size_t before = count;
        std::vector<reading::Finding> findings;
        try {
            findings = findings_of(job::read_survey_file(file));
        } catch (const InputError& error) {
            std::cout << "the amended survey cannot be corrected: " << error.what() << '\n';
            break;
        }
        std::erase_if(findings,
                      [](const reading::Finding& finding) { return finding.amendment.empty(); });
        for (const reading::Finding& finding : findings) try {
                job::add_amendments(job::read_survey_file(file), {finding}, {});
                std::cout << text::in_words(finding.text) << '\n';
                ++count;
            } catch (const InputError&) {
                std::cout << text::in_words(finding.text)
                          << " (contradicts an amendment, not carried out)\n";
            }
        if (count == before) break;
    }
    return count;
}

void amend_survey(const AmendOptions& options) {
    const job::SurveyFile survey = job::read_survey_file(options.survey);
    const std::vector<reading::Finding> findings = findings_of(survey);
    if (!options.is_all && options.findings.empty()) {
        for (std::size_t k = 0; k < findings.size(); ++k)
            std::cout << fmt::format("# {}. {}\n{}", k + 1, text::in_words(findings[k].text),
                                     findings[k].amendment);
        if (findings.empty()) std::cout << "# nothing was found\n";
        return;
    }
    const std::vector<reading::Finding> chosen = chosen_findings(findings, options);
    if (chosen.empty()) {
        std::cout << "nothing to amend\n";
        return;
    }
    const std::filesystem::path file = job::add_amendments(survey, chosen, options.out);
    for (const reading::Finding& finding : chosen)
        std::cout << text::in_words(finding.text) << '\n';
    const std::size_t count = chosen.size() + (options.is_all ? amend_again(options.survey) : 0);
    std::cout << fmt::format("{} amendment{} written to {}; correct the survey again\n", count,
                             count == 1 ? "" : "s", file.string());
}

}  // namespace

void add_amend_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "amend",
        "Writes the amendments that the findings of a survey propose into its amendments file.");
    const auto options = std::make_shared<AmendOptions>();
    add_required(command, "FILE", "", options->survey, "Survey file (TOML)");
    auto* const all = command.add_flag("--all", options->is_all,
                                       "Carry out all proposals, and those of the amended survey, "
                                       "until nothing more is found");
    add_option(command, "--finding", "N", options->findings,
               "Carry out this one, by its number in the list; may be given several times. Without "
               "it and without --all the proposals are only printed")
        ->excludes(all);
    add_option(command, "--out", "FILE", options->out,
               "Amendments file (default: the one of the survey file, else NAME-amendments.toml "
               "beside it)");
    command.callback([options] { amend_survey(*options); });
}

}  // namespace a351::corrector::command
