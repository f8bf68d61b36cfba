/// Makes mistakes in a survey day, one at a time, and counts what the search for mistakes says.
///
///     mistake-trials SURVEY.toml [MOST]
///
/// Prints one line for each kind of trial: kind, trials, those in which the mistake was named as the
/// promise demands, those in which something else was said, and those in a headline.  `attainable` is
/// what the best test reaches on the day.  The sites of the survey must all have a reference.  Ten more sites are in the list, with references within 60 mGal of the others;
/// some are nearer than 5 mGal to a site that was visited.  MOST (default 12) limits the trials of a
/// kind.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "corrector/job/survey_day.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/judgement/mistake_search.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/model/model.hpp"

namespace {

using namespace a351;
using corrector::reading::Finding;
using corrector::reading::FindingKind;
using corrector::reading::OccupationRows;
using corrector::reading::SurveyRow;

constexpr std::size_t kMoreSites = 10;
/// A step is clear from so many standard errors on.
constexpr double kClear = 5.0;

/// Findings of a survey, without the benchmarks that were not visited.
std::vector<Finding> all_findings_of(const corrector::job::SurveyFile& survey,
                                     OccupationRows read) {
    auto findings = corrector::job::correct_survey_day(survey, read).findings;
    std::erase_if(findings, [](const Finding& finding) {
        return finding.kind == FindingKind::not_visited ||
               finding.kind == FindingKind::unusable_day;
    });
    return findings;
}

/// Findings of a survey, without remarks.
std::vector<Finding> findings_of(const corrector::job::SurveyFile& survey, OccupationRows read) {
    auto findings = all_findings_of(survey, std::move(read));
    std::erase_if(findings, corrector::reading::is_remark);
    return findings;
}

struct Count {
    int trials = 0, named = 0, otherwise = 0, otherwise_in_headline = 0;
};

/// Counts a trial.
/// @param is_right  true for a finding that names the mistake.
/// @param wanted    number of such findings.
template <class IsRight>
void count(Count& total, const std::vector<Finding>& findings, int wanted, IsRight is_right) {
    const auto right = std::count_if(findings.begin(), findings.end(), is_right);
    ++total.trials;
    if (right >= wanted) ++total.named;
    bool is_wrong = false, is_headline = false;
    for (const Finding& finding : findings) {
        if (is_right(finding)) continue;
        is_wrong = true;
        is_headline = is_headline || finding.is_headline;
        if (std::getenv("A351_SHOW") != nullptr)
            std::printf("# %s\n", finding.text.english().c_str());
    }
    total.otherwise += is_wrong ? 1 : 0;
    total.otherwise_in_headline += is_headline ? 1 : 0;
}

void print(const char* kind, const Count& total) {
    std::printf("%s %d %d %d %d\n", kind, total.trials, total.named, total.otherwise,
                total.otherwise_in_headline);
    std::fflush(stdout);
}

void set_reference(OccupationRows& read, const std::string& site, MilliGal reference) {
    for (SurveyRow& row : read.rows)
        if (row.site == site) row.reference = reference;
    for (text::Site& listed : read.sites)
        if (listed.name == site) listed.gravity = reference;
}

void set_site(OccupationRows& read, std::size_t i, const text::Site& site) {
    SurveyRow& row = read.rows[i];
    row.site = site.name;
    row.occupation = 90;
    row.reference = site.gravity;
    row.u_reference = site.u_gravity;
}

/// A day and its trials.
class Trials {
public:
    Trials(corrector::job::SurveyFile survey, OccupationRows read, std::size_t most)
        : survey_(std::move(survey)), read_(std::move(read)), most_(most) {
        visited_ = read_.sites.size();
        for (std::size_t k = 0; k < kMoreSites; ++k) {
            text::Site site = read_.sites[draw_() % visited_];
            site.name = "other" + std::to_string(k);
            const double away = k < 3 ? 1.0 + static_cast<double>(draw_() % 400) / 100.0
                                      : 5.0 + static_cast<double>(draw_() % 5500) / 100.0;
            site.gravity = *site.gravity + MilliGal(draw_() % 2 == 0 ? away : -away);
            read_.sites.push_back(site);
        }
    }

    void clean() {
        Count total;
        count(total, all_findings_of(survey_, read_), 0, [](const Finding&) { return false; });
        print("clean", total);
    }

    void references(double size_mgal) {
        Count total;
        for (const std::string& site : drawn(station_names(), most_)) {
            OccupationRows read = read_;
            const double size = draw_() % 2 == 0 ? size_mgal : -size_mgal;
            set_reference(read, site,
                          *text::find_site(read_.sites, site)->gravity + MilliGal(size));
            count(total, findings_of(survey_, std::move(read)), 1, [&](const Finding& finding) {
                if (finding.site != site || !finding.size_mgal) return false;
                // The size of another kind is that of the reading.
                const double off = finding.kind == FindingKind::reference ? size : -size;
                return std::abs(*finding.size_mgal - off) < 3.0 * finding.u_mgal.value_or(1.0);
            });
        }
        print(("reference_" + std::to_string(static_cast<int>(size_mgal))).c_str(), total);
    }

    /// Counts in simulated residuals how often the best test names a reference that is off: it knows
    /// the noise of the day and searches references only.  It takes the one with the largest |t|, and
    /// finds something in kWholeDayMistakeAlpha of the surveys without a mistake.
    void attainable(double size_mgal) {
        namespace model = corrector::model;
        constexpr int kDraws = 4000;
        const auto result = model::correct_with_calibration(
            read_.rows, corrector::job::with_sites_of(read_, survey_.survey), &*read_.day);
        const auto choice =
            model::choose_rows(read_.rows, result.options.datum, result.options.use_flags);
        const auto trials = model::find_model(result.model)
                                ->trials({read_.rows, result.options, &*read_.day}, choice);
        const auto residuals = trials->residuals({}, {});
        std::vector<corrector::adjustment::Effect> effects;
        std::vector<double> information;
        for (const std::string& site : station_names()) {
            corrector::adjustment::Effect& effect = effects.emplace_back();
            for (std::size_t i = 0; i < read_.rows.size(); ++i)
                if (read_.rows[i].site == site) effect.push_back(i);
            information.push_back(residuals->information(effect, effect));
        }
        // t = d'q / sqrt(d'Md); with an effect of size s the readings have q + s M c.
        const auto largest = [&](const corrector::adjustment::Seen& seen,
                                 const corrector::adjustment::Effect& off, double size) {
            std::pair<double, std::size_t> most{0.0, 0};
            for (std::size_t k = 0; k < effects.size(); ++k) {
                double sum = off.empty() ? 0.0 : size * residuals->information(effects[k], off);
                for (const std::size_t i : effects[k])
                    sum += seen.weighted(static_cast<Eigen::Index>(i));
                most = std::max(most, {std::abs(sum) / std::sqrt(information[k]), k});
            }
            return most;
        };
        std::mt19937_64 generator(1);
        std::vector<double> clean;
        for (int k = 0; k < kDraws; ++k)
            clean.push_back(largest(residuals->simulated(generator), {}, 0.0).first);
        const auto limit =
            clean.begin() + static_cast<std::ptrdiff_t>(
                                (1.0 - corrector::judgement::kWholeDayMistakeAlpha) * kDraws);
        std::nth_element(clean.begin(), limit, clean.end());
        Count total;
        for (total.trials = 0; total.trials < kDraws; ++total.trials) {
            const std::size_t off = draw_() % effects.size();
            const auto [t, found] =
                largest(residuals->simulated(generator), effects[off], size_mgal);
            if (t > *limit && found == off) ++total.named;
        }
        print(("attainable_" + std::to_string(static_cast<int>(size_mgal))).c_str(), total);
    }

    void swaps() {
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (std::size_t a = 0; a < read_.rows.size(); ++a)
            for (std::size_t b = a + 1; b < read_.rows.size(); ++b) {
                const SurveyRow &one = read_.rows[a], &other = read_.rows[b];
                if (one.site != other.site &&
                    std::abs((*one.reference - *other.reference).value()) > 5.0)
                    pairs.emplace_back(a, b);
            }
        Count total;
        for (const auto& [a, b] : drawn(pairs, most_)) {
            OccupationRows read = read_;
            std::swap(read.rows[a].site, read.rows[b].site);
            std::swap(read.rows[a].occupation, read.rows[b].occupation);
            std::swap(read.rows[a].reference, read.rows[b].reference);
            count(total, findings_of(survey_, std::move(read)), 2, [&](const Finding& finding) {
                return finding.kind == FindingKind::other_name &&
                       ((finding.site == read_.rows[a].site &&
                         finding.other_site == read_.rows[b].site) ||
                        (finding.site == read_.rows[b].site &&
                         finding.other_site == read_.rows[a].site));
            });
        }
        print("swap", total);
    }

    void other_names() {
        std::vector<std::pair<std::size_t, std::size_t>> slips;
        for (std::size_t i = 0; i < read_.rows.size(); ++i)
            for (std::size_t k = visited_; k < read_.sites.size(); ++k)
                if (std::abs((*read_.rows[i].reference - *read_.sites[k].gravity).value()) > 5.0)
                    slips.emplace_back(i, k);
        Count total;
        int likeliest = 0;
        for (const auto& [i, k] : drawn(slips, most_)) {
            OccupationRows read = read_;
            set_site(read, i, read_.sites[k]);
            const std::string& right = read_.rows[i].site;
            const auto is_of_stay = [&](const Finding& finding) {
                return finding.kind == FindingKind::other_name &&
                       finding.site == read_.sites[k].name;
            };
            const auto findings = findings_of(survey_, std::move(read));
            likeliest +=
                std::ranges::any_of(findings,
                                    [&](const Finding& finding) {
                                        return is_of_stay(finding) && finding.other_site == right;
                                    })
                    ? 1
                    : 0;
            count(total, findings, 1, [&](const Finding& finding) {
                return is_of_stay(finding) &&
                       finding.text.english().find(right + " (") != std::string::npos;
            });
        }
        std::printf("likeliest_name %d %d 0 0\n", total.trials, likeliest);
        print("other_name", total);
    }

    void steps(double size_mgal) {
        std::vector<std::size_t> places;
        for (std::size_t i = 1; i < read_.rows.size(); ++i) places.push_back(i);
        Count total, clear;
        for (const std::size_t place : drawn(places, most_)) {
            OccupationRows read = read_;
            const MilliGal step(draw_() % 2 == 0 ? size_mgal : -size_mgal);
            for (std::size_t i = place; i < read.rows.size(); ++i)
                read.rows[i].acceleration = read.rows[i].acceleration + step;
            for (auto& bin : read.day->bins)
                if (bin.set_up >= place) bin.reading = bin.reading + step;
            const bool is_clear = size_mgal >= kClear * step_error_mgal(read, place);
            const auto findings = findings_of(survey_, std::move(read));
            const auto is_right = [&](const Finding& finding) {
                // At an end of the day one reading off and a step are the same.
                if (finding.code.ends_with("_or_step"))
                    return finding.site == read_.rows[place == 1 ? 0 : place].site;
                return finding.kind == FindingKind::step &&
                       *finding.time > read_.rows[place - 1].time &&
                       *finding.time < read_.rows[place].time;
            };
            count(total, findings, 1, is_right);
            if (is_clear) count(clear, findings, 1, is_right);
        }
        print(("clear_step_" + std::to_string(static_cast<int>(size_mgal))).c_str(), clear);
        print(("step_" + std::to_string(static_cast<int>(size_mgal))).c_str(), total);
    }

private:
    /// Returns the standard error of a step between two readings, as the model gives it.
    [[nodiscard]] double step_error_mgal(const OccupationRows& read, std::size_t place) const {
        auto options = survey_.survey;
        const UtcTime before = read.rows[place - 1].time;
        options.steps = {{before + (read.rows[place].time - before) / 2}};
        const auto result =
            corrector::model::correct_with_calibration(read.rows, options, &*read.day);
        for (const auto& coefficient : result.coefficients)
            if (coefficient.name == "step_1_mgal") return coefficient.standard_error.value();
        return HUGE_VAL;
    }

    [[nodiscard]] std::vector<std::string> station_names() const {
        return corrector::model::station_names(read_.rows);
    }

    template <class Element>
    std::vector<Element> drawn(std::vector<Element> all, std::size_t most) {
        for (std::size_t k = 0; k < std::min(most, all.size()); ++k)
            std::swap(all[k], all[k + draw_() % (all.size() - k)]);
        all.resize(std::min(most, all.size()));
        return all;
    }

    corrector::job::SurveyFile survey_;
    OccupationRows read_;
    std::size_t most_;
    std::size_t visited_ = 0;
    std::mt19937_64 draw_{1};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    const auto survey = corrector::job::read_survey_file(argv[1]);
    const std::size_t most = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 12;
    Trials trials(survey, corrector::job::read_survey(survey, [](std::size_t, std::size_t) {}),
                  most);
    trials.clean();
    if (most == 0) return 0;
    trials.attainable(8.0);
    for (const double size : {8.0, 20.0, 50.0}) trials.references(size);
    trials.swaps();
    trials.other_names();
    for (const double size : {3.0, 5.0, 10.0, 100.0}) trials.steps(size);
}
