#include "corrector/judgement/mistake_sentences.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/model/amended_survey.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/strict_toml.hpp"

namespace a351::corrector::judgement {
namespace {

using reading::Finding;
using reading::FindingKind;
using reading::SurveyRow;

/// Greatest distance from a reference at which a reading is said to be of that site, in standard
/// uncertainties.  Reason: one right name in a hundred is missed.
constexpr double kNameReach = 2.5;
/// A site that has readings of its own is so much less likely to be the right one.  Reason: only the
/// base and a few benchmarks are visited twice; the number itself is a guess.
constexpr double kVisitedOdds = 4.0;

/// Turns mistakes into sentences with proposals.
class MistakeSentences {
public:
    MistakeSentences(const std::vector<SearchedReading>& readings,
                     const std::vector<SurveyRow>& rows, const model::RowChoice& choice,
                     const std::vector<text::Site>& sites)
        : readings_(readings), rows_(rows), choice_(choice), sites_(sites) {}

    [[nodiscard]] std::vector<Finding> of(const Mistake& mistake) const {
        if (mistake.kind == adjustment::AlternativeKind::step) {
            const auto lone = lone_stay(mistake);
            return {lone ? stay_or_step(lone->stay, lone->other) : step(mistake)};
        }
        if (mistake.kind == adjustment::AlternativeKind::swap) return swapped_names(mistake);
        if (mistake.kind == adjustment::AlternativeKind::set_up) return {bad_set_up(mistake)};
        if (mistake.kind == adjustment::AlternativeKind::station)
            if (const std::string rival = rival_of(first(mistake).site); !rival.empty())
                return {contradiction(mistake, rival)};
        // At an end of the day a step is as likely as a name.
        const bool is_name_likely =
            is_one_stay(mistake) &&
            (mistake.kind == adjustment::AlternativeKind::station || !step_beside(mistake));
        const auto others = is_name_likely ? read_sites(mistake) : std::vector<Candidate>();
        Finding finding = !others.empty() ? other_name(mistake, others)
                          : mistake.kind == adjustment::AlternativeKind::station
                              ? reference(mistake)
                              : bad_stay(mistake);
        add_step(finding, mistake);
        return {std::move(finding)};
    }

private:
    [[nodiscard]] const SurveyRow& first(const Mistake& mistake) const {
        return rows_[mistake.readings.front()];
    }

    [[nodiscard]] Finding finding_of(const Mistake& mistake, FindingKind kind, std::string code,
                                     const SurveyRow& row) const {
        Finding finding{.kind = kind, .code = std::move(code)};
        set_stay(finding, row);
        set_size(finding, mistake);
        return finding;
    }

    static void set_size(Finding& finding, const Mistake& mistake) {
        finding.size_mgal = mistake.size_mgal;
        finding.u_mgal = mistake.u_mgal;
        finding.is_headline = mistake.p <= kHeadlineP && !mistake.needed_trial;
    }

    [[nodiscard]] bool is_one_stay(const Mistake& mistake) const {
        return std::ranges::all_of(mistake.readings, [&](std::size_t i) {
            return reading::is_same_stay(rows_[i], first(mistake));
        });
    }

    /// Returns "12.3 +- 1.5 mGal too high".
    static text::Message off_by(double size_mgal, double u_mgal) {
        const std::string size = in_mgal(std::abs(size_mgal), u_mgal), u = in_mgal(u_mgal, u_mgal);
        return size_mgal > 0.0 ? text::message("{} +- {} mGal too high", size, u)
                               : text::message("{} +- {} mGal too low", size, u);
    }

    /// Returns a size with the decimals that its uncertainty allows: readings of a spring gravimeter
    /// are a thousand times as sure as those of the sensor.
    static std::string in_mgal(double size_mgal, double u_mgal) {
        constexpr double kFine_mgal = 0.05;  // below it one decimal is 0.0
        return text::fixed(size_mgal, u_mgal < kFine_mgal ? 4 : 1);
    }

    /// Returns an amendment of the stay of a row; empty if there can be none.
    static std::string amendment(std::string_view kind, const SurveyRow& row, bool has_set_up,
                                 const std::string& rest) {
        if (row.listed.site.empty()) return {};
        reading::ListedSetUp listed = row.listed;
        if (!has_set_up) listed.set_up.reset();
        return reading::amendment_head(kind, listed) + rest;
    }

    static std::string exclusion(const SurveyRow& row, bool has_set_up, const Mistake& mistake) {
        return amendment("exclude", row, has_set_up,
                         fmt::format("reason = \"off by {} mGal\"\n",
                                     in_mgal(mistake.size_mgal, mistake.u_mgal)));
    }

    /// A site at which a reading may have been made instead of at the one that it names.
    struct Candidate {
        const text::Site* site = nullptr;
        double distance_mgal = 0.0;
        double cost = 0.0;  ///< -2 ln(likelihood)
    };

    /// Returns the sites at which the reading may have been made, the likeliest first: their
    /// gravity is about the reference of the named site plus the size of the mistake.
    [[nodiscard]] std::vector<Candidate> read_sites(const Mistake& mistake) const {
        std::vector<Candidate> candidates;
        const SurveyRow& row = first(mistake);
        if (!choice_.in_use[mistake.readings.front()]) return candidates;  // no reference is held
        const MilliGal read = *row.reference + MilliGal(mistake.size_mgal);
        for (const text::Site& site : sites_) {
            if (!site.gravity || site.name == row.site || is_refused(site.name)) continue;
            const double u =
                std::hypot(mistake.u_mgal, site.u_gravity.value_or(MilliGal(0.0)).value());
            const double distance_mgal = std::abs((read - *site.gravity).value());
            if (distance_mgal > kNameReach * u) continue;
            double cost = std::pow(distance_mgal / u, 2);
            if (std::ranges::find(rows_, site.name, &SurveyRow::site) != rows_.end())
                cost += 2.0 * std::log(kVisitedOdds);
            candidates.push_back({&site, distance_mgal, cost});
        }
        std::ranges::stable_sort(candidates, {}, &Candidate::cost);
        return candidates;
    }

    /// Says that a stay at an end of the day may be good, and the instrument have stepped next to it.
    void add_step(Finding& finding, const Mistake& mistake) const {
        if (const auto after = step_beside(mistake))
            add_step(finding, model::reading_before(rows_, *after), *after);
    }
    void add_step(Finding& finding, std::size_t before, std::size_t after) const {
        finding.code += "_or_step";
        finding.text += text::message("; or the instrument stepped between {} and {}",
                                      stay_name(rows_[before]), stay_name(rows_[after]));
    }

    /// A stay that is off if the instrument did not step.
    struct LoneStay {
        Mistake stay;
        std::size_t other = 0;  ///< The nearest reading beyond the step that shows it.
    };

    /// Returns the only stay on one side of a step that shows it, if it is at a known station: all
    /// others there are of unknown stations without a reading elsewhere.
    [[nodiscard]] std::optional<LoneStay> lone_stay(const Mistake& step) const {
        const std::size_t from = step.readings.front();
        std::vector<std::size_t> sides[2];  // readings before and after it
        for (std::size_t i = 0; i < rows_.size(); ++i)
            if (choice_.accepted[i] && readings_[i].loop == readings_[from].loop)
                sides[i < from ? 0 : 1].push_back(i);
        // Other loops tie a station too.
        const auto shows_it = [&](std::size_t i, const std::vector<std::size_t>& own_side) {
            if (choice_.in_use[i]) return true;
            for (std::size_t k = 0; k < rows_.size(); ++k)
                if (choice_.accepted[k] && rows_[k].site == rows_[i].site &&
                    std::ranges::count(own_side, k) == 0)
                    return true;
            return false;
        };
        for (const bool is_after : {true, false}) {
            std::vector<std::size_t> own, beyond;
            for (const std::size_t i : sides[is_after])
                if (shows_it(i, sides[is_after])) own.push_back(i);
            for (const std::size_t i : sides[!is_after])
                if (shows_it(i, sides[!is_after])) beyond.push_back(i);
            Mistake stay = step;
            stay.kind = adjustment::AlternativeKind::stay;
            stay.readings = own;
            if (!is_after) stay.size_mgal = -step.size_mgal;
            if (!own.empty() && !beyond.empty() && choice_.in_use[own.front()] && is_one_stay(stay))
                return LoneStay{std::move(stay), is_after ? beyond.back() : beyond.front()};
        }
        return std::nullopt;
    }

    /// Says that a stay has a wrong name or is bad, or that the instrument stepped.
    [[nodiscard]] Finding stay_or_step(const Mistake& stay, std::size_t other) const {
        // With the drift that a step may have hidden, u can reach the reference of any site.
        constexpr double kClear_u = 10.0;
        const auto others = std::abs(stay.size_mgal) < kClear_u * stay.u_mgal
                                ? std::vector<Candidate>()
                                : read_sites(stay);
        Finding finding = others.empty() ? finding_of(stay, FindingKind::bad_reading,
                                                      "stay_disagrees", first(stay))
                                         : other_name(stay, others);
        if (others.empty()) {
            finding.text =
                text::message("{} is {}: its name or its reference is wrong, or the stay is bad",
                              stay_name(first(stay)), off_by(stay.size_mgal, stay.u_mgal));
            finding.amendment = exclusion(first(stay), false, stay);
        }
        add_step(finding, std::min(other, stay.readings.back()),
                 std::max(other, stay.readings.front()));
        finding.text += text::message("; another known benchmark shows which");
        return finding;
    }

    /// Returns the first reading after a step that would look like this mistake, if there is one.
    [[nodiscard]] std::optional<std::size_t> step_beside(const Mistake& mistake) const {
        const std::size_t from = mistake.readings.front(), to = mistake.readings.back();
        std::ptrdiff_t before = 0, within = 0, after = 0;
        std::size_t next = 0;
        for (std::size_t i = rows_.size(); i-- > 0;) {
            if (!choice_.accepted[i] || readings_[i].loop != readings_[from].loop) continue;
            ++(i < from ? before : i > to ? after : within);
            if (i > to) next = i;
        }
        if (within != std::ssize(mistake.readings)) return std::nullopt;
        if ((before == 0) == (after == 0)) return std::nullopt;
        return before == 0 ? next : from;
    }

    /// Returns true if an amendment refuses the reference of a site.
    [[nodiscard]] bool is_refused(const std::string& site) const {
        return std::ranges::any_of(rows_, [&](const SurveyRow& row) {
            return row.site == site && row.is_reference_refused;
        });
    }

    [[nodiscard]] Finding step(const Mistake& mistake) const {
        const std::size_t after = mistake.readings.front();
        Finding finding{.kind = FindingKind::step, .code = "step"};
        finding.time = model::time_before(rows_, after);
        set_size(finding, mistake);
        finding.text = text::message(
            "between {} and {} the instrument stepped: from then on the readings are {}",
            stay_name(rows_[model::reading_before(rows_, after)]), stay_name(rows_[after]),
            off_by(mistake.size_mgal, mistake.u_mgal));
        if (!rows_[after].listed.site.empty())
            finding.amendment = fmt::format(
                "[[step]]\ntime_utc = \"{}\"\nreason = \"step of {} mGal\"\n",
                to_rfc3339(*finding.time, 3), in_mgal(mistake.size_mgal, mistake.u_mgal));
        return finding;
    }

    /// Returns one finding for each stay.  The amendment of the first renames both, because half of it
    /// would make two stays of one site.
    [[nodiscard]] std::vector<Finding> swapped_names(const Mistake& mistake) const {
        Finding one = swapped(mistake, mistake.readings, mistake.others, mistake.size_mgal),
                other = swapped(mistake, mistake.others, mistake.readings, -mistake.size_mgal);
        one.amendment += other.amendment;
        other.amendment.clear();
        return {std::move(one), std::move(other)};
    }

    [[nodiscard]] Finding swapped(const Mistake& mistake, const std::vector<std::size_t>& own,
                                  const std::vector<std::size_t>& others, double size_mgal) const {
        const SurveyRow& row = rows_[own.front()];
        const SurveyRow& other = rows_[others.front()];
        Finding finding = finding_of(mistake, FindingKind::other_name, "swapped", row);
        finding.size_mgal = size_mgal;
        finding.u_mgal.reset();
        finding.other_site = other.site;
        finding.text = text::message("{} reads like {}, and {} like {}: the names were swapped",
                                     stay_name(row), other.site, stay_name(other), row.site);
        finding.amendment = reading::rename_amendment(row, other.site, "names swapped");
        return finding;
    }

    [[nodiscard]] Finding other_name(const Mistake& mistake,
                                     const std::vector<Candidate>& others) const {
        constexpr std::size_t kMostNames = 3;
        const SurveyRow& row = first(mistake);
        const text::Site& other = *others.front().site;
        Finding finding = finding_of(mistake, FindingKind::other_name, "other_name", row);
        finding.other_site = other.name;
        text::Message names;
        for (std::size_t i = 0; i < std::min(kMostNames, others.size()); ++i) {
            if (i > 0) names += text::message(" or ");
            names += fmt::format("{} ({} mGal)", others[i].site->name,
                                 in_mgal(others[i].distance_mgal, mistake.u_mgal));
        }
        finding.text = text::message("{} is {}; it reads like {}", stay_name(row),
                                     off_by(mistake.size_mgal, mistake.u_mgal), names);
        if (mistake.kind == adjustment::AlternativeKind::station) {
            finding.code = "other_name_or_reference";
            finding.text += text::message("; if the name is right, the reference of {} is {}",
                                          row.site, off_by(-mistake.size_mgal, mistake.u_mgal));
        }
        finding.amendment = reading::rename_amendment(row, other.name, "reads like " + other.name);
        return finding;
    }

    /// Returns the other reference if the fit holds two: nothing shows which of them is wrong.
    [[nodiscard]] std::string rival_of(const std::string& site) const {
        std::string rival;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (!choice_.in_use[i] || rows_[i].site == site || rows_[i].site == rival) continue;
            if (!rival.empty()) return {};
            rival = rows_[i].site;
        }
        return rival;
    }

    [[nodiscard]] Finding contradiction(const Mistake& mistake, const std::string& rival) const {
        const SurveyRow& row = first(mistake);
        Finding finding = finding_of(mistake, FindingKind::reference, "references_contradict", row);
        finding.other_site = rival;
        finding.text = text::message(
            "the references of {} and {} contradict each other by {} +- {} mGal, or a stay "
            "there is bad; nothing shows which",
            row.site, rival, in_mgal(std::abs(mistake.size_mgal), mistake.u_mgal),
            in_mgal(mistake.u_mgal, mistake.u_mgal));
        return finding;
    }

    [[nodiscard]] Finding reference(const Mistake& mistake) const {
        const SurveyRow& row = first(mistake);
        Finding finding = finding_of(mistake, FindingKind::reference, "reference", row);
        finding.size_mgal = -mistake.size_mgal;
        finding.text = text::message("the reference of {} is {}", row.site,
                                     off_by(-mistake.size_mgal, mistake.u_mgal));
        if (is_one_stay(mistake)) {
            finding.code = "reference_or_reading";
            finding.text += text::message(", or its only stay is bad: look at both");
        }
        if (!row.listed.site.empty())
            finding.amendment = fmt::format(
                "[[reference]]\nsite = {}\nuse = false\nreason = \"off by {} mGal\"\n",
                text::toml_string(row.site), in_mgal(-mistake.size_mgal, mistake.u_mgal));
        return finding;
    }

    [[nodiscard]] Finding bad_stay(const Mistake& mistake) const {
        const SurveyRow& row = first(mistake);
        Finding finding = finding_of(mistake, FindingKind::bad_reading, "stay_disagrees", row);
        finding.text =
            text::message("{} is {}, unlike the other readings of {}: repeat it", stay_name(row),
                          off_by(mistake.size_mgal, mistake.u_mgal), row.site);
        finding.amendment = exclusion(row, false, mistake);
        return finding;
    }

    [[nodiscard]] Finding bad_set_up(const Mistake& mistake) const {
        const std::size_t i = mistake.readings.front();
        const SurveyRow& row = rows_[i];
        Finding finding = finding_of(mistake, FindingKind::bad_reading, "set_up_disagrees", row);
        const auto number =
            row.listed.set_up
                ? *row.listed.set_up
                : 1 + std::count_if(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(i),
                                    [&](const SurveyRow& other) {
                                        return reading::is_same_stay(other, row);
                                    });
        finding.text = text::message("set-up {} of {} is {}, unlike the others: repeat it", number,
                                     stay_name(row), off_by(mistake.size_mgal, mistake.u_mgal));
        finding.amendment = exclusion(row, true, mistake);
        return finding;
    }

    const std::vector<SearchedReading>& readings_;
    const std::vector<SurveyRow>& rows_;
    const model::RowChoice& choice_;
    const std::vector<text::Site>& sites_;
};

}  // namespace

std::vector<Finding> findings_of(const Mistake& mistake,
                                 const std::vector<SearchedReading>& readings,
                                 const std::vector<SurveyRow>& rows, const model::RowChoice& choice,
                                 const std::vector<text::Site>& sites) {
    return MistakeSentences(readings, rows, choice, sites).of(mistake);
}

}  // namespace a351::corrector::judgement
